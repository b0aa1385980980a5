#include "metrology/base_frame.h"

#include "metrology/common_perpendicular.h"

namespace stiffscope {

Eigen::Isometry3d baseFrame(const Line& axis_1, const Line& axis_2) {
  const Eigen::Vector3d z = axis_1.direction.normalized();
  const Eigen::Vector3d y = (axis_2.direction - z.dot(axis_2.direction) * z).normalized();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() << y.cross(z), y, z;
  frame.translation() = commonPerpendicular(axis_1, axis_2).foot_on_first;
  return frame;
}

}  // namespace stiffscope
