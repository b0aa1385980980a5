#include "metrology/measured_line.h"

#include <Eigen/Geometry>

namespace stiffscope {

Line MeasuredLine::moved(const Eigen::Vector4d& step) const {
  return {line.point + step[0] * across_u + step[1] * across_v,
          (line.direction + step[2] * across_u + step[3] * across_v).normalized()};
}

MeasuredLine MeasuredLine::reversed() const {
  MeasuredLine other = *this;
  other.line.direction = -line.direction;
  other.covariance.topRightCorner<2, 2>() *= -1.0;
  other.covariance.bottomLeftCorner<2, 2>() *= -1.0;
  return other;
}

Eigen::Vector4d MeasuredLine::stepTo(const Line& other) const {
  const double along = line.direction.dot(other.direction);
  const double to_plane = line.direction.dot(line.point - other.point) / along;
  const Eigen::Vector3d shift = other.point + to_plane * other.direction - line.point;
  return {across_u.dot(shift), across_v.dot(shift), across_u.dot(other.direction) / along,
          across_v.dot(other.direction) / along};
}

void basisAcross(const Eigen::Vector3d& direction, Eigen::Vector3d& u, Eigen::Vector3d& v) {
  u = direction.unitOrthogonal();
  v = direction.cross(u);
}

}  // namespace stiffscope
