#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_in_r0.h"
#include "core/frames/frames_covariance.h"
#include "core/frames/link_geometry.h"
#include "core/frames/measured_axes.h"
#include "core/frames/targets_at_zero.h"
#include "core/frames/wrist_centre.h"

namespace stiffscope {

/// Everything the sweeps give (paper, II.D): axes, R0, the arm in R0, link lengths, P_TCP, the wrist centre.
struct Frames {
  std::array<MeasuredAxis, 6> axes;
  ArmInR0 arm;
  PointFrame points_frame = PointFrame::tracker;  ///< the frame of the sweeps' readings
  std::array<LinkGeometry, 5> links;
  std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero;
  WristCentre wrist;
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();  ///< P_TCP: where axis 6 pierces the flange plane
  OwnWeight weight;              ///< in R0
  bool sag_removed = false;      ///< readings were referred to the rigid arm
  double largest_sag = 0.0;      ///< of a reading of the sweeps, taken off, m
  std::string sag_note;          ///< why not, or with which stiffnesses
  FramesCovariance covariance;   ///< of R0, links and wrist; the arm's own sag is in it as far as stiffnesses tell
};

/// With the arm taken as rigid under its own weight.
Frames measureFrames(const Campaign& campaign);

/// Once more with the sag taken off the readings: by the joint compliances given (rad/Nm) and the arm as measured so
/// far. Its error is that of `so_far` shrunk about a thousandfold. Where masses are not known, `so_far` with a note.
/// `covariance` of the compliances, where it is given and finite, is propagated into that of the frames, by differences
/// of the whole measurement. It knows nothing of what is wrong with a sag by joint springs alone: bearings that
/// give across their axes bend the arm too, and falsify the springs; LinkGeometry::distance_by_sag shows the stake.
Frames refineFrames(const Campaign& campaign, const Frames& so_far, const Vector6d& compliance,
                    const std::optional<Matrix6d>& covariance = std::nullopt);

/// r0_from_points for a table: the measured frame for readings in the sweeps' frame; for readings in base_link with
/// sweeps by the tracker, or none, the URDF's. Empty where the frame of the table is not known in R0.
std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, PointFrame table_frame);

}  // namespace stiffscope
