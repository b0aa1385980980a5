#include "metrology/cylinder_starts.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiffscope {

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
  Eigen::Matrix<double, 9, 3> lift =
      Eigen::Matrix<double, 9, 3>::Zero();  // nine numbers to (|Px|^2, u.x, v.x)
  lift.col(0).head<6>() << 1.0 - w.x() * w.x(), 1.0 - w.y() * w.y(), 1.0 - w.z() * w.z(),
      -2.0 * w.y() * w.z(), -2.0 * w.x() * w.z(), -2.0 * w.x() * w.y();
  lift.col(1).tail<3>() = u;
  lift.col(2).tail<3>() = v;
  const double square = lift.col(0).dot(all.mean);
  const double lever = 2.0 * std::sqrt(std::max(square, 1e-300));
  lift.col(0) /= lever;
  const Eigen::Matrix3d moments = lift.transpose() * all.covariance * lift;
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
        const Candidate there = circleAlong(
            (from.direction + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized(), all);
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
  for (const Eigen::Vector3d& direction : halfSphere(kDirections))
    candidates.push_back(circleAlong(direction, all));
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
      return std::abs(other.model.axis.direction().dot(minimum.direction)) > std::cos(kSame);
    };
    if (starts.size() == most || !std::isfinite(minimum.expected)) break;
    if (std::any_of(starts.begin(), starts.end(), same)) continue;
    starts.push_back({{AxisFrame(minimum.centre, minimum.direction)}, minimum.radius, minimum.expected});
  }
  return starts;
}

}  // namespace stiffscope
