#include "core/frames/frames.h"

#include <functional>

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
  frames.links = linkGeometry(campaign.robot, frames.arm);
  frames.targets_in_r0_at_zero = targetsAtZero(campaign, frames.arm, points);
  frames.wrist = measureWristCentre(campaign, frames.arm, points, frames.targets_in_r0_at_zero);
  frames.tcp_in_flange = tcpInFlange(frames.arm.arm);
  frames.weight = ownWeight(campaign.robot, campaign.tool, campaign.gravity_in_base, frames.arm.arm, frames.arm.r0_from_base_link);
  return frames;
}

/// How the numbers of FramesCovariance differ between two measurements.
Eigen::VectorXd change(const Frames& from, const Frames& to, std::size_t targets) {
  using At = FramesCovariance;
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(At::kRadii + static_cast<Eigen::Index>(targets));
  numbers.segment<6>(At::kR0) = frameError(from.arm.r0_from_points.inverse(), to.arm.r0_from_points.inverse());
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    numbers[At::kDistances + row] = to.links[i].distance - from.links[i].distance;
    numbers[At::kAngles + row] = to.links[i].angle - from.links[i].angle;
  }
  if (!from.wrist.measured || !to.wrist.measured) return numbers;
  numbers.segment<3>(At::kWristCentre) = to.wrist.centre_in_r0 - from.wrist.centre_in_r0;
  for (const int target : from.wrist.targets) {
    const auto k = static_cast<std::size_t>(target);
    numbers[At::kRadii + target] = to.wrist.radii[k] - from.wrist.radii[k];
  }
  return numbers;
}

/// The part of the covariance that comes from the compliances, by differences of the whole measurement.
std::optional<Eigen::MatrixXd> sagPart(const Frames& frames, const Vector6d& compliance, const Matrix6d& covariance,
                                       const std::function<Frames(const Vector6d&)>& measuredWith) {
  if (!frames.arm.points_placed) return std::nullopt;
  constexpr double kStep = 1e-8;  // rad/Nm: a hundredth of a stiff joint's; the sag is linear far beyond it
  const std::size_t targets = frames.targets_in_r0_at_zero.size();
  Eigen::MatrixXd by_compliance =
      Eigen::MatrixXd::Zero(FramesCovariance::kRadii + static_cast<Eigen::Index>(targets), 6);
  for (int joint = 0; joint < 6; ++joint) {
    if (covariance(joint, joint) == 0.0) continue;
    const Frames moved = measuredWith(compliance + kStep * Vector6d::Unit(joint));
    if (moved.arm.points_placed) by_compliance.col(joint) = change(frames, moved, targets) / kStep;
  }
  return by_compliance * covariance * by_compliance.transpose();
}

void propagate(const Campaign& campaign, Frames& frames, const std::optional<Eigen::MatrixXd>& sag = std::nullopt) {
  const Eigen::Vector3d station = campaign.tracker ? campaign.tracker->station : Eigen::Vector3d::Zero();
  frames.covariance = framesCovariance(frames.axes, frames.arm, frames.links, frames.wrist, campaign.targets.size(), station);
  if (sag) frames.covariance.sag = *sag;
  stateUncertainties(frames.covariance, frames.axes, frames.arm, frames.links, frames.wrist);
}

}  // namespace

Frames measureFrames(const Campaign& campaign) {
  Frames frames = measureOnce(campaign, SagModel());
  propagate(campaign, frames);
  frames.sag_note = frames.weight.links_known
                        ? "no stiffness is known, so the arm's own sag is left in"
                        : "the robot's link masses are not known, so the arm's own sag is left in";
  return frames;
}

Frames refineFrames(const Campaign& campaign, const Frames& so_far, const Vector6d& compliance,
                    const std::optional<Matrix6d>& covariance) {
  if (!so_far.weight.links_known) return so_far;
  const auto measuredWith = [&](const Vector6d& c) {
    return measureOnce(campaign, SagModel(so_far.arm.arm, so_far.weight, c, so_far.targets_in_r0_at_zero,
                                          so_far.arm.r0_from_points.inverse()));
  };
  Frames frames = measuredWith(compliance);
  frames.sag_removed = true;
  frames.sag_note = "the arm's own sag is taken off the readings by the identified stiffnesses and the URDF's masses";
  const Frames as_read = measureOnce(campaign, SagModel());
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    frames.links[i].distance_by_sag = frames.links[i].distance - as_read.links[i].distance;
  }
  propagate(campaign, frames, covariance && covariance->allFinite()
                                  ? sagPart(frames, compliance, *covariance, measuredWith)
                                  : std::nullopt);
  return frames;
}

std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, PointFrame table_frame) {
  if (frames.arm.points_placed && table_frame == frames.points_frame) return frames.arm.r0_from_points;
  if (table_frame == PointFrame::base_link) return frames.arm.r0_from_base_link;
  return std::nullopt;
}

}  // namespace stiffscope
