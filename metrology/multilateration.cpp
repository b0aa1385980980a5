#include "metrology/multilateration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "metrology/least_squares.h"
#include "metrology/trilateration.h"

namespace stiffscope::metrology {

namespace {

/// One place, seen from known points at known distances. The points' covariances take in those of the
/// distances.
class PlaceModel : public Model {
 public:
  PlaceModel(const Eigen::Vector3d& start, const std::vector<double>& distances)
      : place(start), distances_(distances), before_(start) {}

  Size size() const override { return {3, 0, 1}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double*, Observation& seen) const override {
    long double square = 0.0L;
    for (int k = 0; k < 3; ++k) {
      const long double from = static_cast<long double>(place[k]) - point[k];
      square += from * from;
    }
    const long double distance = std::sqrt(square);
    seen.residual[0] = static_cast<double>(distance - distances_[i]);
    const Eigen::Vector3d towards = distance > 0.0L
                                        ? Eigen::Vector3d((place - point) / static_cast<double>(distance))
                                        : Eigen::Vector3d::UnitX();
    seen.rows[0] = {towards.x(), towards.y(), towards.z()};
    seen.directions[0] = towards;
  }
  void move(const Eigen::VectorXd& step) override {
    before_ = place;
    place += Eigen::Vector3d(step);
  }
  void undo() override { place = before_; }

  Eigen::Vector3d place;

 private:
  const std::vector<double>& distances_;
  Eigen::Vector3d before_;
};

struct PlaceEstimate : Estimate {
  Eigen::Vector3d place;
};

/// The points with what their distances add: sd^2 in every direction is sd^2 along that to the place.
MeasuredPoints pointsOf(const std::vector<MeasuredDistance>& distances) {
  MeasuredPoints points;
  bool weighted = false;
  for (const MeasuredDistance& one : distances) {
    points.points.push_back(one.from);
    points.covariances.push_back(one.covariance + one.sd * one.sd * Eigen::Matrix3d::Identity());
    weighted = weighted || !points.covariances.back().isZero(0.0);
  }
  if (!weighted) points.covariances.clear();
  return points;
}

std::array<std::size_t, 3> largestTriangle(const std::vector<Eigen::Vector3d>& points) {
  std::array<std::size_t, 3> best{0, 1, 2};
  double largest = -1.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        const double area = (points[j] - points[i]).cross(points[k] - points[i]).squaredNorm();
        if (area > largest) largest = area, best = {i, j, k};
      }
    }
  }
  return best;
}

/// Do the distances speak for the first of the two, at 95 %?
bool preferred(const PlaceEstimate& best, const PlaceEstimate& other, bool weighted, double rounding) {
  constexpr double kChiSquare1 = 3.8415;
  const int dof = best.degreesOfFreedom();
  const double variance = weighted ? 1.0 : dof > 0 ? std::max(best.chi2 / dof, rounding * rounding) : 0.0;
  return dof > 0 && other.chi2 > best.chi2 + kChiSquare1 * variance;
}

/// Is the place held to first order in its worst known direction n? A step of two standard uncertainties
/// along it changes the distances by n.e_i to first and by 1/(2 d_i) of its square to second order; in the
/// plane of the points the first vanishes, and the linear uncertainty means nothing.
bool heldToFirstOrder(const PlaceEstimate& found, const std::vector<Eigen::Vector3d>& anchors,
                      double variance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(Eigen::Matrix3d(found.cofactor));
  const Eigen::Vector3d worst = eigen.eigenvectors().col(2);
  const double two_sd = 2.0 * std::sqrt(variance * eigen.eigenvalues()[2]);
  double first = 0.0, second = 0.0;
  for (const Eigen::Vector3d& anchor : anchors) {
    const double square = (found.place - anchor).squaredNorm();
    first += std::pow(worst.dot(found.place - anchor), 2) / square;
    second += 1.0 / square;
  }
  return first > two_sd * two_sd * second;
}

}  // namespace

Multilateration multilaterate(const std::vector<MeasuredDistance>& distances,
                              const std::optional<Eigen::Vector3d>& expected) {
  Multilateration result;
  if (distances.size() < 3) {
    result.reason = "fewer than three distances";
    return result;
  }
  const MeasuredPoints points = pointsOf(distances);
  const LocalPoints local = localPoints(&points, 1);
  result.reason = local.flaw;
  if (!result.reason.empty()) return result;
  std::vector<double> lengths;
  for (const MeasuredDistance& one : distances) lengths.push_back(one.distance / local.scale);
  const bool positive =
      std::all_of(lengths.begin(), lengths.end(), [](double d) { return d >= 0.0 && std::isfinite(d); });
  const auto& anchors = local.groups.front().points;
  const auto [i, j, k] = largestTriangle(anchors);
  const auto both = trilaterate({anchors[i], anchors[j], anchors[k]}, {lengths[i], lengths[j], lengths[k]});
  if (!positive || !both) {
    result.reason = positive ? "the points lie on one line" : "a distance is negative or not a finite number";
    return result;
  }

  std::vector<PlaceEstimate> found;
  for (const Eigen::Vector3d& root : both->roots) {
    // Off the plane of the three: on it the sum does not change across it, and no step would leave it.
    const Eigen::Vector3d across = (anchors[j] - anchors[i]).cross(anchors[k] - anchors[i]).normalized();
    const double side = found.empty() ? 1.0 : -1.0;
    const Eigen::Vector3d start =
        both->height_squared > 0.0 ? root : Eigen::Vector3d(root + 0.1 * side * across);
    PlaceModel model(start, lengths);
    const Estimate fitted = fitLeastSquares(model, local);
    found.push_back({fitted, model.place});
  }
  const double rounding = 16.0 * (local.rounding + std::numeric_limits<double>::epsilon());
  std::erase_if(found, [&](const PlaceEstimate& one) {
    const double least = local.weighted() ? 0.0 : rounding * rounding;
    const double variance = std::max(varianceFactor(one, local.weighted()), least);
    return !one.determined || !heldToFirstOrder(one, anchors, variance);
  });
  if (found.empty()) {
    result.reason =
        "the place lies in the plane of the points, or the spheres miss each other: its height across it is "
        "free";
    return result;
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
  const auto placeOf = [&local](const PlaceEstimate& one) -> Eigen::Vector3d {
    return local.origin + local.scale * one.place;
  };
  constexpr double kSame = 1e-6;  // local units: both starts came to one place
  const bool two = found.size() > 1 && (found[0].place - found[1].place).norm() > kSame;
  if (two && !preferred(found[0], found[1], local.weighted(), rounding)) {
    if (!expected) {
      result.reason = "two places, one on each side of the points' plane, agree with the distances alike";
      return result;
    }
    if ((placeOf(found[1]) - *expected).norm() < (placeOf(found[0]) - *expected).norm())
      std::swap(found[0], found[1]);
    result.mirror = placeOf(found[1]);
  }
  const PlaceEstimate& best = found.front();
  result.degrees_of_freedom = best.degreesOfFreedom();
  if (!local.weighted() && result.degrees_of_freedom < 1) {
    result.reason = "three distances without their uncertainty leave nothing to tell that of the place by";
    result.mirror.reset();
    return result;
  }
  result.point = placeOf(best);
  result.covariance = local.scale * local.scale * varianceFactor(best, local.weighted()) * best.cofactor;
  result.rms = local.scale * std::sqrt(best.plain / best.residuals);
  const int dof = result.degrees_of_freedom;
  result.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? best.chi2 / dof : 0.0;
  result.determined = true;
  return result;
}

}  // namespace stiffscope::metrology
