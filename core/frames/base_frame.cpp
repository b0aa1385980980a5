#include "core/frames/base_frame.h"

#include "core/robot/balancer.h"
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

namespace {

metrology::Line movedBy(const Eigen::Isometry3d& motion, const metrology::Line& line) {
  return {motion * line.point, motion.linear() * line.direction};
}

/// The nominal robot with R0 as its base frame.
robot::Robot inFrame(const robot::Robot& nominal, const Eigen::Isometry3d& r0_from_base_link) {
  robot::Robot robot = nominal;
  for (metrology::Line& axis : robot.axes_in_base_at_zero) axis = movedBy(r0_from_base_link, axis);
  for (robot::BodyMass& body : robot.bodies) body.com_in_base_at_zero = r0_from_base_link * body.com_in_base_at_zero;
  for (robot::Balancer& balancer : robot.balancers) robot::moveEnds(r0_from_base_link, balancer);
  for (robot::LinkFrame& link : robot.links)
    link.base_from_link_at_zero = r0_from_base_link * link.base_from_link_at_zero;
  robot.base_from_flange_at_zero = r0_from_base_link * nominal.base_from_flange_at_zero;
  return robot;
}

}  // namespace

std::size_t axisAcrossLast(const robot::ArmAxes& axes) {
  std::size_t across = axes.size() - 2;
  while (across > 0 && metrology::angleBetween(axes[across], axes.back()) < metrology::kNearParallel) --across;
  return across;
}

void carryFlange(const robot::ArmAxes& from, robot::Robot& arm) {
  // baseFrame with the last axis as z and the one across as y: any fixed rule serves, the same for both sets of axes.
  const robot::ArmAxes& to = arm.axes_in_base_at_zero;
  const std::size_t across = axisAcrossLast(from);
  const Eigen::Isometry3d carry =
      metrology::baseFrame(to.back(), to[across]) * metrology::baseFrame(from.back(), from[across]).inverse();
  arm.base_from_flange_at_zero = carry * arm.base_from_flange_at_zero;
  for (robot::LinkFrame& link : arm.links) {
    if (link.body == arm.axes()) link.base_from_link_at_zero = carry * link.base_from_link_at_zero;
  }
}

ArmInR0 armInR0(const robot::Robot& nominal, const MeasuredAxes& axes) {
  ArmInR0 result;
  const NominalBaseFrame rule = nominalBaseFrame(nominal);
  result.r0_from_base_link = rule.base_link_from_r0.inverse();
  result.arm = inFrame(nominal, result.r0_from_base_link);
  result.points_placed = axes[0].measured && axes[1].measured;
  if (!result.points_placed) return result;

  metrology::Line axis_1 = axes[0].at_zero.line, axis_2 = axes[1].at_zero.line;
  axis_1.direction *= rule.sense[0];
  axis_2.direction *= rule.sense[1];
  result.r0_from_points = metrology::baseFrame(axis_1, axis_2).inverse();

  const robot::ArmAxes nominal_in_r0 = result.arm.axes_in_base_at_zero;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i].measured) continue;
    metrology::Line& axis = result.arm.axes_in_base_at_zero[i];
    const metrology::Line measured = movedBy(result.r0_from_points, axes[i].at_zero.line);
    axis = {metrology::nearestPoint(measured, axis.point), measured.direction};
  }
  if (axes[axisAcrossLast(nominal_in_r0)].measured && axes.back().measured) carryFlange(nominal_in_r0, result.arm);
  return result;
}

NominalBaseFrame nominalBaseFrame(const robot::Robot& robot) {
  NominalBaseFrame nominal;
  metrology::Line axis_1 = robot.axes_in_base_at_zero[0], axis_2 = robot.axes_in_base_at_zero[1];
  if (axis_1.direction.z() < 0.0) {
    nominal.sense[0] = -1.0;
    axis_1.direction = -axis_1.direction;
  }
  const Eigen::Vector3d flange = robot.base_from_flange_at_zero.translation();
  const Eigen::Vector3d towards_flange = flange - metrology::nearestPoint(axis_1, flange);
  constexpr double kNearAxis = 0.050;  // m, campaign format, Frames
  if (towards_flange.norm() >= kNearAxis) {
    const Eigen::Vector3d x = metrology::baseFrame(axis_1, axis_2).linear().col(0);
    if (x.dot(towards_flange) < 0.0) {
      nominal.sense[1] = -1.0;
      axis_2.direction = -axis_2.direction;
    }
  }
  nominal.base_link_from_r0 = metrology::baseFrame(axis_1, axis_2);
  return nominal;
}

}  // namespace stiffscope::frames
