#include "core/frames/nominal_base_frame.h"

#include "metrology/base_frame.h"
#include "metrology/common_perpendicular.h"

namespace stiffscope {

NominalBaseFrame nominalBaseFrame(const Robot& robot) {
  NominalBaseFrame nominal;
  Line axis_1 = robot.axes_in_base_at_zero[0], axis_2 = robot.axes_in_base_at_zero[1];
  if (axis_1.direction.z() < 0.0) {
    nominal.sense[0] = -1.0;
    axis_1.direction = -axis_1.direction;
  }
  const Eigen::Vector3d flange = robot.base_from_flange_at_zero.translation();
  const Eigen::Vector3d towards_flange = flange - nearestPoint(axis_1, flange);
  constexpr double kNearAxis = 0.050;  // m, campaign format, Frames
  if (towards_flange.norm() >= kNearAxis) {
    const Eigen::Vector3d x = baseFrame(axis_1, axis_2).linear().col(0);
    if (x.dot(towards_flange) < 0.0) {
      nominal.sense[1] = -1.0;
      axis_2.direction = -axis_2.direction;
    }
  }
  nominal.base_link_from_r0 = baseFrame(axis_1, axis_2);
  return nominal;
}

}  // namespace stiffscope
