#include "metrology/least_squares.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace stiffscope::metrology {

namespace {

Eigen::Vector3d meanOf(const MeasuredPoints* groups, std::size_t count, std::size_t points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    for (const Eigen::Vector3d& point : groups[k].points) mean += point;
  }
  return mean / static_cast<double>(points);
}

std::string flawOfCovariances(const MeasuredPoints& group, bool expected) {
  if (!expected && group.covariances.empty()) return {};
  if (group.covariances.size() != group.points.size()) return "the covariances are not one a reading";
  for (const Eigen::Matrix3d& covariance : group.covariances) {
    const Eigen::LLT<Eigen::Matrix3d> cholesky(covariance);
    if (!covariance.allFinite() || cholesky.info() != Eigen::Success) {
      return "a reading's covariance is not positive definite";
    }
  }
  return {};
}

}  // namespace

std::size_t LocalPoints::count() const {
  std::size_t sum = 0;
  for (const LocalGroup& group : groups) sum += group.points.size();
  return sum;
}

LocalPoints localPoints(const MeasuredPoints* groups, std::size_t count) {
  LocalPoints local;
  std::size_t points = 0;
  for (std::size_t k = 0; k < count; ++k) points += groups[k].points.size();
  if (points == 0) {
    local.flaw = "no readings";
    return local;
  }
  const bool weighted = !groups[0].covariances.empty();
  for (std::size_t k = 0; k < count && local.flaw.empty(); ++k) {
    local.flaw = flawOfCovariances(groups[k], weighted);
  }
  if (!local.flaw.empty()) return local;

  local.origin = meanOf(groups, count, points);
  double size = 0.0, farthest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    for (const Eigen::Vector3d& point : groups[k].points) {
      // Written so that a coordinate that is not a number stays one.
      const double from_mean = (point - local.origin).cwiseAbs().sum();
      if (!(from_mean <= std::numeric_limits<double>::max())) {
        local.flaw = "a reading is not a finite number";
        return local;
      }
      size = std::max(size, (point - local.origin).cwiseAbs().maxCoeff());
      farthest = std::max(farthest, point.cwiseAbs().maxCoeff());
    }
  }
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  constexpr double kDigits = 1e4;     // of the spread that double precision must hold
  constexpr double kLargest = 1e140;  // covariances and their sums are squares
  if (!(size > 4.0 * kRounding * farthest)) {
    local.flaw = "the readings all lie in one place";
  } else if (farthest > kLargest || size < 1.0 / kLargest) {
    local.flaw = "the readings are too large or too small for squares in double precision";
  } else if (size < kDigits * kRounding * farthest) {
    local.flaw = "the readings lie so far from the origin that double precision does not hold their spread";
  }
  if (!local.flaw.empty()) return local;

  local.scale = std::exp2(std::floor(std::log2(size)));
  local.rounding = kRounding * farthest / local.scale;
  local.groups.resize(count);
  const double inverse = 1.0 / local.scale;
  for (std::size_t k = 0; k < count; ++k) {
    local.groups[k].points.reserve(groups[k].points.size());
    for (const Eigen::Vector3d& point : groups[k].points) {
      local.groups[k].points.push_back(inverse * (point - local.origin));
    }
    if (weighted) local.groups[k].covariances = &groups[k].covariances;
  }
  return local;
}

PrincipalAxes principalAxes(const LocalPoints& local) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const LocalGroup& group : local.groups) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : group.points) mean += point;
    mean /= std::max<double>(1.0, static_cast<double>(group.points.size()));
    for (const Eigen::Vector3d& point : group.points) {
      const Eigen::Vector3d from_mean = point - mean;
      scatter.noalias() += from_mean * from_mean.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

bool spreads(double small, double large, const LocalPoints& local) {
  constexpr double kFlat = 1e-12;  // squared
  const double rounding = 8.0 * local.rounding;
  return small > kFlat * large && small > rounding * rounding * static_cast<double>(local.count());
}

bool standsOut(double greater, double lesser, std::size_t count) {
  constexpr double kOfOneScatter = 4.9;
  const double both = std::sqrt(std::max(0.0, lesser) * greater / static_cast<double>(count));
  return greater - lesser > std::max(kOfOneScatter * both, 1e-9 * greater);
}

}  // namespace stiffscope::metrology
