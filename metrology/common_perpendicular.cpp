#include "metrology/common_perpendicular.h"

#include <Eigen/Geometry>
#include <cmath>

namespace stiffscope {

CommonPerpendicular commonPerpendicular(const Line& first, const Line& second) {
  // The difference of the feet is at right angles to both directions: a 2x2 system for the two places.
  const Eigen::Vector3d between = second.point - first.point;
  const double cosine = first.direction.dot(second.direction);
  const double sine_squared = first.direction.cross(second.direction).squaredNorm();
  const double along_first = between.dot(first.direction);
  const double along_second = between.dot(second.direction);
  CommonPerpendicular result;
  const double s = sine_squared > 0.0 ? (along_first - cosine * along_second) / sine_squared : 0.0;
  const double t = cosine * s - along_second;
  result.foot_on_first = first.point + s * first.direction;
  result.foot_on_second = second.point + t * second.direction;
  result.distance = (result.foot_on_second - result.foot_on_first).norm();
  result.angle = angleBetween(first, second);
  return result;
}

double distanceAcross(const Line& first, const Line& second, const Eigen::Vector3d& at_point) {
  const Eigen::Vector3d on_first = nearestPoint(first, at_point);
  const double t = first.direction.dot(on_first - second.point) / first.direction.dot(second.direction);
  return (second.point + t * second.direction - on_first).norm();
}

double angleBetween(const Line& first, const Line& second) {
  return std::atan2(first.direction.cross(second.direction).norm(),
                    std::abs(first.direction.dot(second.direction)));
}

Eigen::Vector3d nearestPoint(const Line& line, const Eigen::Vector3d& point) {
  return line.point + line.direction.dot(point - line.point) * line.direction;
}

}  // namespace stiffscope
