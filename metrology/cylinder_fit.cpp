#include "metrology/cylinder_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrology/least_squares.h"
#include "metrology/measured_points.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

/// A cylinder that an algebraic search finds, in local units, with the sum of squared distances that it
/// expects.
struct CylinderStart {
  AxisFrame axis;
  double radius = 0.0;
  double expected = 0.0;
};

/// For an axis direction w the points projected along it should lie on a circle, and Taubin's circle of them
/// follows from the covariance of the nine numbers (x^2, y^2, z^2, yz, xz, xy, x, y, z): with P = I - w w',
/// |P x|^2 is linear in them (after D. Eberly, Fitting 3D Data with a Cylinder, whose sum this makes
/// Taubin's). That covariance is summed once, so that a search over the half sphere costs the same for any
/// number of points. Returns the local minima over it, refined, the best first, `most` at most.
std::vector<CylinderStart> cylinderStarts(const LocalPoints& local, std::size_t most);

namespace {

using Moments = Eigen::Matrix<double, 9, 9>;

struct Gathered {
  Moments covariance = Moments::Zero();  ///< sums over the points, about the mean of the nine
  Eigen::Matrix<double, 9, 1> mean = Eigen::Matrix<double, 9, 1>::Zero();
  double count = 0.0;
};

Eigen::Matrix<double, 9, 1> ninth(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 9, 1> nine;
  nine << p.x() * p.x(), p.y() * p.y(), p.z() * p.z(), p.y() * p.z(), p.x() * p.z(), p.x() * p.y(), p;
  return nine;
}

Gathered gather(const std::vector<Eigen::Vector3d>& points) {
  Gathered all;
  all.count = static_cast<double>(points.size());
  for (const Eigen::Vector3d& point : points) all.mean += ninth(point) / all.count;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Matrix<double, 9, 1> from_mean = ninth(point) - all.mean;
    all.covariance.noalias() += from_mean * from_mean.transpose();
  }
  return all;
}

struct Candidate {
  Eigen::Vector3d direction, centre;
  double radius = 0.0, expected = 0.0;
};

/// Taubin's circle of the points seen along `w`.
Candidate circleAlong(const Eigen::Vector3d& w, const Gathered& all) {
  Eigen::Vector3d u, v;
  basisAcross(w, u, v);
  Eigen::Matrix<double, 9, 3> lift = Eigen::Matrix<double, 9, 3>::Zero();  // nine numbers to (|Px|^2, u.x, v.x)
  lift.col(0).head<6>() << 1.0 - w.x() * w.x(), 1.0 - w.y() * w.y(), 1.0 - w.z() * w.z(), -2.0 * w.y() * w.z(),
      -2.0 * w.x() * w.z(), -2.0 * w.x() * w.y();
  lift.col(1).tail<3>() = u;
  lift.col(2).tail<3>() = v;
  const double square = lift.col(0).dot(all.mean);
  const double lever = 2.0 * std::sqrt(std::max(square, 1e-300));
  lift.col(0) /= lever;
  const Eigen::Matrix<double, 9, 3> lifted = all.covariance * lift;
  const Eigen::Matrix3d moments = lift.transpose() * lifted;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments);
  const Eigen::Vector3d least = eigen.eigenvectors().col(0);
  const Eigen::Vector2d centre = -0.5 * lever * least.tail<2>() / least[0];
  Candidate found{w, centre[0] * u + centre[1] * v, 0.0, eigen.eigenvalues()[0]};
  found.radius = std::sqrt(square + centre.squaredNorm());
  constexpr double kStraight = 1e-9;  // as good as a plane: no cylinder
  if (!(std::abs(least[0]) > kStraight)) found.expected = std::numeric_limits<double>::infinity();
  return found;
}

/// Downhill by ever smaller steps around the direction.
Candidate descend(Candidate from, double step, const Gathered& all) {
  constexpr double kFine = 1e-4;  // rad: from there Gauss-Newton goes on
  for (; step > kFine; step *= 0.5) {
    for (bool better = true; better;) {
      better = false;
      Eigen::Vector3d u, v;
      basisAcross(from.direction, u, v);
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4.0;
        const Candidate there =
            circleAlong((from.direction + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized(), all);
        if (there.expected < 0.999 * from.expected) from = there, better = true;
      }
    }
  }
  return from;
}

/// Even over the half sphere (spherical Fibonacci points).
std::vector<Eigen::Vector3d> halfSphere(int count) {
  std::vector<Eigen::Vector3d> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    const double z = (k + 0.5) / count, across = std::sqrt(1.0 - z * z);
    directions.emplace_back(across * std::cos(golden * k), across * std::sin(golden * k), z);
  }
  return directions;
}

}  // namespace

std::vector<CylinderStart> cylinderStarts(const LocalPoints& local, std::size_t most) {
  const Gathered all = gather(local.groups.front().points);
  constexpr int kDirections = 400;  // about 7 degrees apart
  constexpr double kApart = 0.125;  // rad, their distance
  constexpr double kSame = 0.02;    // rad: the same minimum
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& direction : halfSphere(kDirections)) candidates.push_back(circleAlong(direction, all));
  const PrincipalAxes axes = principalAxes(local);
  for (int k = 0; k < 3; ++k) candidates.push_back(circleAlong(axes.directions.col(k), all));
  const auto better = [](const Candidate& a, const Candidate& b) { return a.expected < b.expected; };
  std::sort(candidates.begin(), candidates.end(), better);

  // From the best on, each that has no better one beside it is a minimum of its own.
  std::vector<Candidate> minima;
  for (std::size_t k = 0; k < candidates.size() && minima.size() < 4 * most; ++k) {
    const auto beside = [&](const Candidate& other) {
      return std::abs(other.direction.dot(candidates[k].direction)) > std::cos(1.6 * kApart);
    };
    if (std::none_of(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(k), beside)) {
      minima.push_back(descend(candidates[k], 0.5 * kApart, all));
    }
  }
  std::sort(minima.begin(), minima.end(), better);
  std::vector<CylinderStart> starts;
  for (const Candidate& minimum : minima) {
    const auto same = [&](const CylinderStart& other) {
      return std::abs(other.axis.direction().dot(minimum.direction)) > std::cos(kSame);
    };
    if (starts.size() == most || !std::isfinite(minimum.expected)) break;
    if (std::any_of(starts.begin(), starts.end(), same)) continue;
    starts.push_back({AxisFrame(minimum.centre, minimum.direction), minimum.radius, minimum.expected});
  }
  return starts;
}

namespace {

struct CylinderEstimate : Estimate {
  AxisFrame axis;
  double radius() const { return own(0, 0); }
};

/// Other minima are followed where the algebraic sum does not speak against them by far: it is the geometric
/// one but for weights and curvature.
constexpr double kFarWorse = 100.0;
constexpr std::size_t kMostStarts = 12;

bool sameAxis(const CylinderEstimate& a, const CylinderEstimate& b) {
  constexpr double kSame = 1e-5;  // rad and local units
  const double across = a.axis.direction().cross(b.axis.direction()).norm();
  return across < kSame && std::abs(a.radius() - b.radius()) < kSame * (1.0 + a.radius());
}

/// Every cylinder to which a start leads, the least sum first.
std::vector<CylinderEstimate> localMinima(const LocalPoints& local) {
  std::vector<CylinderEstimate> found;
  const std::vector<CylinderStart> starts = cylinderStarts(local, kMostStarts);
  const double rounding = local.rounding + std::numeric_limits<double>::epsilon();
  for (const CylinderStart& start : starts) {
    const double floor = static_cast<double>(local.count()) * rounding * rounding;
    if (start.expected > kFarWorse * (starts.front().expected + floor) && !found.empty()) break;
    CylindersModel model(start.axis);
    const Estimate fitted = fitLeastSquares(model, local, Eigen::MatrixXd::Constant(1, 1, start.radius));
    const CylinderEstimate estimate{fitted, model.axis};
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const auto& other) { return sameAxis(other, estimate); });
    if (estimate.converged && !known) found.push_back(estimate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
  return found;
}

/// Do the readings speak for the first of the two, at 95 %? Without covariances the noise is not known
/// beforehand, and only sums that are equal to rounding leave the choice open.
bool preferred(const CylinderEstimate& best, const CylinderEstimate& other, const LocalPoints& local) {
  if (local.weighted()) {
    constexpr double kChiSquare1 = 3.8415;
    return other.chi2 > best.chi2 + kChiSquare1;
  }
  const double rounding = 16.0 * (local.rounding + std::numeric_limits<double>::epsilon());
  return other.chi2 > 1.000001 * best.chi2 + static_cast<double>(local.count()) * rounding * rounding;
}

void writeResult(const CylinderEstimate& estimate, const LocalPoints& local, FittedCylinder& fit) {
  const AxisFrame& axis = estimate.axis;
  const double along = -axis.direction().dot(axis.point());
  const Eigen::Vector3d direction = largestPositive(axis.direction());
  const double sense = direction.dot(axis.direction()) < 0.0 ? -1.0 : 1.0;
  fit.cylinder = {{local.origin + local.scale * (axis.point() + along * axis.direction()), direction},
                  local.scale * estimate.radius()};
  if (!tellsUncertainty(estimate, local)) return;
  Eigen::Matrix<double, 7, 5> full;  // (point, direction, radius) by (shifts, tilts, radius)
  full << axis.u(), axis.v(), along * axis.u(), along * axis.v(), Eigen::Vector3d::Zero(),               //
      Eigen::Matrix<double, 3, 2>::Zero(), sense * axis.u(), sense * axis.v(), Eigen::Vector3d::Zero(),  //
      Eigen::Matrix<double, 1, 4>::Zero(), 1.0;
  full.topRows<3>() *= local.scale;
  full.row(6) *= local.scale;
  fit.covariance = covarianceOf(full, estimate, local.weighted());
}

Remark whyNotSignificant(const FittedCylinder& fit) {
  if (!fit.covariance) return {};
  if (std::sqrt(fit.covariance->block<3, 3>(3, 3).trace()) > kNoDirection) {
    return Remark(RemarkId::axis_direction_in_scatter);
  }
  if (!curved(fit.cylinder.radius, std::sqrt((*fit.covariance)(6, 6)))) {
    return Remark(RemarkId::radius_of_plane);
  }
  return {};
}

}  // namespace

FittedCylinder fitCylinder(const MeasuredPoints& points) {
  FittedCylinder fit;
  fit.method = Remark(RemarkId::cylinder_least_sum);
  const LocalPoints local = localPoints(&points, 1);
  fit.reason = tooFewReadings(5, points.points.size());
  if (fit.reason.empty()) fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  const PrincipalAxes axes = principalAxes(local);
  if (!spreads(axes.spread[0], axes.spread[2], local)) {
    fit.reason = spreads(axes.spread[1], axes.spread[2], local) ? Remark(RemarkId::axis_in_one_plane)
                                                                : Remark(RemarkId::axis_on_one_line);
    return fit;
  }
  const std::vector<CylinderEstimate> minima = localMinima(local);
  if (minima.empty()) {
    fit.reason = Remark(RemarkId::no_nearest_cylinder);
    return fit;
  }
  if (!describeQuality(minima.front(), local, fit)) return fit;
  if (minima.size() > 1 && !preferred(minima[0], minima[1], local)) {
    fit.reason = Remark(RemarkId::two_cylinders_alike);
    return fit;
  }
  writeResult(minima.front(), local, fit);
  fit.reason = whyNotSignificant(fit);
  if (!fit.reason.empty()) {
    fit.cylinder = {};
    fit.covariance.reset();
    return fit;
  }
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope::metrology
