#include "core/audit/moved_axes.h"

namespace stiffscope {

MovedAxes::MovedAxes(const Frames& frames) {
  const Eigen::Isometry3d& r0_from_points = frames.arm.r0_from_points;
  for (std::size_t j = 0; j < 6; ++j) {
    axes_[j] = frames.axes[j].at_zero;
    axes_[j].line = {r0_from_points * axes_[j].line.point, r0_from_points.linear() * axes_[j].line.direction};
    axes_[j].across_u = r0_from_points.linear() * axes_[j].across_u;
    axes_[j].across_v = r0_from_points.linear() * axes_[j].across_v;
  }
}

ArmPosture MovedAxes::postureWithMoved(const Robot& arm, const Vector6d& q, std::size_t axis,
                                       int parameter) const {
  Robot changed = arm;
  const Line moved = axes_[axis].moved(kStep * Eigen::Vector4d::Unit(parameter));
  changed.axes_in_base_at_zero[axis].point += moved.point - axes_[axis].line.point;
  changed.axes_in_base_at_zero[axis].direction += moved.direction - axes_[axis].line.direction;
  return postureAt(changed, q);
}

}  // namespace stiffscope
