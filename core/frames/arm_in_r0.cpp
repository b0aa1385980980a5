#include "core/frames/arm_in_r0.h"

#include "core/frames/nominal_base_frame.h"
#include "metrology/base_frame.h"
#include "metrology/common_perpendicular.h"

namespace stiffscope {

namespace {

Line movedBy(const Eigen::Isometry3d& motion, const Line& line) {
  return {motion * line.point, motion.linear() * line.direction};
}

/// The nominal robot with R0 as its base frame.
Robot inFrame(const Robot& nominal, const Eigen::Isometry3d& r0_from_base_link) {
  Robot robot = nominal;
  for (Line& axis : robot.axes_in_base_at_zero) axis = movedBy(r0_from_base_link, axis);
  for (BodyMass& body : robot.bodies) body.com_in_base_at_zero = r0_from_base_link * body.com_in_base_at_zero;
  for (LinkFrame& link : robot.links) link.base_from_link_at_zero = r0_from_base_link * link.base_from_link_at_zero;
  robot.base_from_flange_at_zero = r0_from_base_link * nominal.base_from_flange_at_zero;
  return robot;
}

Eigen::Isometry3d frameOnAxes56(const std::array<Line, 6>& axes) {
  // baseFrame with axis 6 as z and axis 5 as y: any fixed rule serves, the same for both sets of axes.
  return baseFrame(axes[5], axes[4]);
}

}  // namespace

Eigen::Isometry3d flangeCarry(const std::array<Line, 6>& nominal, const std::array<Line, 6>& actual) {
  return frameOnAxes56(actual) * frameOnAxes56(nominal).inverse();
}

ArmInR0 armInR0(const Robot& nominal, const std::array<MeasuredAxis, 6>& axes) {
  ArmInR0 result;
  const NominalBaseFrame rule = nominalBaseFrame(nominal);
  result.r0_from_base_link = rule.base_link_from_r0.inverse();
  result.arm = inFrame(nominal, result.r0_from_base_link);
  result.points_placed = axes[0].measured && axes[1].measured;
  if (!result.points_placed) return result;

  Line axis_1 = axes[0].at_zero.line, axis_2 = axes[1].at_zero.line;
  axis_1.direction *= rule.sense[0];
  axis_2.direction *= rule.sense[1];
  result.r0_from_points = baseFrame(axis_1, axis_2).inverse();

  const std::array<Line, 6> nominal_in_r0 = result.arm.axes_in_base_at_zero;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!axes[i].measured) continue;
    Line& axis = result.arm.axes_in_base_at_zero[i];
    const Line measured = movedBy(result.r0_from_points, axes[i].at_zero.line);
    axis = {nearestPoint(measured, axis.point), measured.direction};
  }
  if (axes[4].measured && axes[5].measured) {
    const Eigen::Isometry3d carry = flangeCarry(nominal_in_r0, result.arm.axes_in_base_at_zero);
    result.arm.base_from_flange_at_zero = carry * result.arm.base_from_flange_at_zero;
    for (LinkFrame& link : result.arm.links) {
      if (link.body == 6) link.base_from_link_at_zero = carry * link.base_from_link_at_zero;
    }
  }
  return result;
}

}  // namespace stiffscope
