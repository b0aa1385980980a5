#include "core/frames/frames.h"

namespace stiffscope {

namespace {

/// Where axis 6 pierces the plane z = 0 of the flange, in flange axes.
Eigen::Vector3d tcpInFlange(const Robot& arm) {
  const Eigen::Isometry3d flange_from_base = arm.base_from_flange_at_zero.inverse();
  const Line& axis_6 = arm.axes_in_base_at_zero[5];
  const Eigen::Vector3d point = flange_from_base * axis_6.point;
  const Eigen::Vector3d direction = flange_from_base.linear() * axis_6.direction;
  if (direction.z() == 0.0) return Eigen::Vector3d::Zero();
  return point - point.z() / direction.z() * direction;
}

Frames measureOnce(const Campaign& campaign, const SagModel& sag) {
  const RigidPoints points = rigidPoints(campaign, sag);
  Frames frames;
  frames.largest_sag = points.largest_sag;
  if (campaign.circle_sweeps) frames.points_frame = campaign.circle_sweeps->frame;
  frames.axes = measureAxes(campaign, points);
  frames.arm = armInR0(campaign.robot, frames.axes);
  frames.links = linkGeometry(campaign.robot, frames.arm, frames.axes);
  frames.targets_in_r0_at_zero = targetsAtZero(campaign, frames.arm, points);
  frames.wrist = measureWristCentre(campaign, frames.arm, frames.axes, points, frames.targets_in_r0_at_zero);
  frames.tcp_in_flange = tcpInFlange(frames.arm.arm);
  frames.weight = ownWeight(campaign, frames.arm.arm, frames.arm.r0_from_base_link);
  return frames;
}

}  // namespace

Frames measureFrames(const Campaign& campaign) {
  Frames frames = measureOnce(campaign, SagModel());
  frames.sag_note = frames.weight.links_known
                        ? "no stiffness is known, so the arm's own sag is left in"
                        : "the robot's link masses are not known, so the arm's own sag is left in";
  return frames;
}

Frames refineFrames(const Campaign& campaign, const Frames& so_far, const Vector6d& compliance) {
  if (!so_far.weight.links_known) return so_far;
  const SagModel sag(so_far.arm.arm, so_far.weight, compliance, so_far.targets_in_r0_at_zero,
                     so_far.arm.r0_from_points.inverse());
  Frames frames = measureOnce(campaign, sag);
  frames.sag_removed = true;
  frames.sag_note = "the arm's own sag is taken off the readings by the identified stiffnesses and the URDF's masses";
  return frames;
}

std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, PointFrame table_frame) {
  if (frames.arm.points_placed && table_frame == frames.points_frame) return frames.arm.r0_from_points;
  if (table_frame == PointFrame::base_link) return frames.arm.r0_from_base_link;
  return std::nullopt;
}

}  // namespace stiffscope
