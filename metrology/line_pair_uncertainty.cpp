#include "metrology/line_pair_uncertainty.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "metrology/common_perpendicular.h"

namespace stiffscope {

double propagatePair(const MeasuredLine& first, const MeasuredLine& second,
                     const std::function<double(const Line&, const Line&)>& number) {
  constexpr double kStep = 1e-7;  // m and rad: the numbers here are smooth over micrometres
  Eigen::Vector4d by_first, by_second;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
    by_first[k] =
        (number(first.moved(step), second.line) - number(first.moved(-step), second.line)) / (2.0 * kStep);
    by_second[k] =
        (number(first.line, second.moved(step)) - number(first.line, second.moved(-step))) / (2.0 * kStep);
  }
  return std::sqrt(by_first.dot(first.covariance * by_first) + by_second.dot(second.covariance * by_second));
}

double distanceUncertainty(const MeasuredLine& first, const MeasuredLine& second) {
  // The signed distance along the common normal is smooth through zero, the distance is not.
  const Eigen::Vector3d normal = first.line.direction.cross(second.line.direction).normalized();
  return propagatePair(first, second, [&](const Line& a, const Line& b) {
    const Eigen::Vector3d across = a.direction.cross(b.direction).normalized();
    return (across.dot(normal) < 0.0 ? -1.0 : 1.0) * across.dot(b.point - a.point);
  });
}

double distanceAcrossUncertainty(const MeasuredLine& first, const MeasuredLine& second,
                                 const Eigen::Vector3d& at_point) {
  return propagatePair(first, second,
                       [&](const Line& a, const Line& b) { return distanceAcross(a, b, at_point); });
}

double angleUncertainty(const MeasuredLine& first, const MeasuredLine& second) {
  // The angle has no derivative where it is 0: the tilt about the common normal has, and is the angle to first order.
  // Exactly parallel lines have no common normal: there the larger of the tilts in two planes.
  const auto tiltAbout = [&](const Eigen::Vector3d& normal) {
    return propagatePair(first, second, [&](const Line& a, const Line& b) {
      const double cosine = a.direction.dot(b.direction);
      return std::atan2(normal.dot(a.direction.cross(b.direction)) * (cosine < 0.0 ? -1.0 : 1.0), std::abs(cosine));
    });
  };
  const Eigen::Vector3d cross = first.line.direction.cross(second.line.direction);
  constexpr double kParallel = 1e-12;
  if (cross.norm() > kParallel) return tiltAbout(cross.normalized());
  return std::max(tiltAbout(first.across_u), tiltAbout(first.across_v));
}

}  // namespace stiffscope
