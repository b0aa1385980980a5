#include "core/frames/arm_geometry.h"

#include "core/frames/base_frame.h"
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

MovedAxes::MovedAxes(const Frames& frames) {
  const Eigen::Isometry3d& r0_from_points = frames.arm.r0_from_points;
  for (std::size_t j = 0; j < 6; ++j) {
    axes_[j] = frames.axes[j].at_zero;
    axes_[j].line = {r0_from_points * axes_[j].line.point, r0_from_points.linear() * axes_[j].line.direction};
    axes_[j].across_u = r0_from_points.linear() * axes_[j].across_u;
    axes_[j].across_v = r0_from_points.linear() * axes_[j].across_v;
  }
}

robot::ArmPosture MovedAxes::postureWithMoved(const robot::Robot& arm, const Vector6d& q, std::size_t axis,
                                              int parameter) const {
  robot::Robot changed = arm;
  const metrology::Line moved = axes_[axis].moved(kStep * Eigen::Vector4d::Unit(parameter));
  changed.axes_in_base_at_zero[axis].point += moved.point - axes_[axis].line.point;
  changed.axes_in_base_at_zero[axis].direction += moved.direction - axes_[axis].line.direction;
  return robot::postureAt(changed, q);
}

LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps, const Eigen::Vector3d& centre) {
  LoadingGeometry result = geometry;
  robot::Robot& arm = result.arm;
  for (std::size_t j = 0; j < 6; ++j) {
    const Eigen::Vector4d own = steps.segment<4>(4 * static_cast<Eigen::Index>(j));
    metrology::Line& axis = arm.axes_in_base_at_zero[j];
    Eigen::Vector3d u, v;
    metrology::basisAcross(axis.direction, u, v);
    axis = {axis.point + own[0] * u + own[1] * v, (axis.direction + own[2] * u + own[3] * v).normalized()};
  }
  if (!steps.segment<8>(16).isZero()) {
    const Eigen::Isometry3d carry = flangeCarry(geometry.arm.axes_in_base_at_zero, arm.axes_in_base_at_zero);
    arm.base_from_flange_at_zero = carry * arm.base_from_flange_at_zero;
    for (robot::LinkFrame& link : arm.links) {
      if (link.body == 6) link.base_from_link_at_zero = carry * link.base_from_link_at_zero;
    }
  }
  if (result.r0_from_loading) {
    result.r0_from_loading =
        metrology::motionAbout(centre, steps.segment<6>(GeometrySteps::kAxes)) * *geometry.r0_from_loading;
  }
  for (std::size_t t = 0; t < result.targets_at_zero.size(); ++t) {
    if (!result.targets_at_zero[t]) continue;
    *result.targets_at_zero[t] +=
        steps.segment<3>(GeometrySteps::kAxes + GeometrySteps::kBase + 3 * static_cast<Eigen::Index>(t));
  }
  return result;
}

LoadingGeometry sweptGeometry(const campaign::Campaign& campaign, const Frames& frames, const Vector6d& compliance) {
  LoadingGeometry geometry;
  geometry.arm = frames.arm.arm;
  geometry.targets_at_zero = frames.targets_in_r0_at_zero;
  geometry.r0_from_base_link = frames.arm.r0_from_base_link;
  geometry.weight = frames.weight;
  geometry.compliance = frames.weight.links_known ? compliance : Vector6d::Zero();
  if (campaign.loading) geometry.r0_from_loading = r0FromTable(frames, campaign.loading->frame);
  if (campaign.displacements) {
    if (const auto r0_from_table = r0FromTable(frames, campaign.displacements->frame)) {
      geometry.displacements_in_r0 = r0_from_table->linear();
    }
  }
  return geometry;
}

}  // namespace stiffscope::frames
