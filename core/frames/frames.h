#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/base_frame.h"
#include "core/frames/gravity_sag.h"
#include "core/frames/joint_axes.h"
#include "core/frames/link_geometry.h"
#include "core/frames/wrist_centre.h"
#include "metrology/remark.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

/// Joint covariance of what the sweeps give, with everything that they have in common: R0 in all that is expressed in
/// it, an axis in the two links that it ends, the sag's stiffnesses in everything. In the order
///   error of R0: rotation vector, origin (FrameError: R0 as measured against the true one, in R0's axes),
///   five distances and five angles between consecutive axes,
///   the wrist centre at the wrist sweep's posture, in R0 as measured,
///   the radius of each target of the campaign;
/// rad and m; rows of what was not measured are zero.
struct FramesCovariance {
  static constexpr Eigen::Index kR0 = 0, kDistances = 6, kAngles = 11, kWristCentre = 16, kRadii = 19;

  Eigen::MatrixXd readings;  ///< by the noise of the sweeps' readings
  Eigen::MatrixXd sag;       ///< by the covariance of the stiffnesses with which the arm's sag was taken off
  Eigen::VectorXd by_scale;  ///< how a relative error of the tracker's scale, common to all readings, moves each

  /// `scale_sd` is the relative standard uncertainty of the tracker's scale. The campaign format has none; 1 K of air
  /// temperature that is not known makes 1e-6 (Edlen's equation of the refractive index of air).
  Eigen::MatrixXd total(double scale_sd = 0.0) const;
  metrology::FrameCovariance r0() const { return total().topLeftCorner<6, 6>(); }
};

/// By the law of propagation (GUM 5.2.2), with `sag` zero. Size 19 + the campaign's targets; all zero where R0 is not
/// placed in the frame of the readings. `station`: the tracker's, in that frame.
FramesCovariance framesCovariance(const std::array<MeasuredAxis, 6>& axes, const ArmInR0& arm,
                                  const std::array<LinkGeometry, 5>& links, const WristCentre& wrist,
                                  std::size_t targets, const Eigen::Vector3d& station);

/// Puts the standard uncertainties into links and wrist.
void stateUncertainties(const FramesCovariance& covariance, const std::array<MeasuredAxis, 6>& axes, const ArmInR0& arm,
                        std::array<LinkGeometry, 5>& links, WristCentre& wrist);

/// Where each reflector would stand in R0 with all joints at zero: the mean of its sweep readings, referred to the
/// rigid arm and turned back by their joint angles. Where a target's place on the flange is declared and no
/// reading shows it, that place. Empty for a target that neither gives.
std::vector<std::optional<Eigen::Vector3d>> targetsAtZero(const campaign::Campaign& campaign, const ArmInR0& arm,
                                                          const RigidPoints& points);

/// Everything the sweeps give (paper, II.D): axes, R0, the arm in R0, link lengths, P_TCP, the wrist centre.
struct Frames {
  std::array<MeasuredAxis, 6> axes;
  ArmInR0 arm;
  campaign::PointFrame points_frame = campaign::PointFrame::tracker;  ///< the frame of the sweeps' readings
  std::array<LinkGeometry, 5> links;
  std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero;
  WristCentre wrist;
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();  ///< P_TCP: where axis 6 pierces the flange plane
  robot::GravityLoad weight;                                ///< in R0
  bool sag_removed = false;                                 ///< readings were referred to the rigid arm
  double largest_sag = 0.0;                                 ///< of a reading of the sweeps, taken off, m
  Remark sag_note;                                          ///< why not, or with which stiffnesses
  FramesCovariance covariance;  ///< of R0, links and wrist; the arm's own sag is in it as far as stiffnesses tell
};

/// With the arm taken as rigid under its own weight.
Frames measureFrames(const campaign::Campaign& campaign);

/// Once more with the sag taken off the readings: by the joint compliances given (rad/Nm) and the arm as measured so
/// far. Its error is that of `so_far` shrunk about a thousandfold. Where masses are not known, `so_far` with a note.
/// `covariance` of the compliances, where it is given and finite, is propagated into that of the frames, by differences
/// of the whole measurement. It knows nothing of what is wrong with a sag by joint springs alone: bearings that
/// give across their axes bend the arm too, and falsify the springs; LinkGeometry::distance_by_sag shows the stake.
Frames refineFrames(const campaign::Campaign& campaign, const Frames& so_far, const Vector6d& compliance,
                    const std::optional<Matrix6d>& covariance = std::nullopt);

/// r0_from_points for a table: the measured frame for readings in the sweeps' frame; for readings in base_link with
/// sweeps by the tracker, or none, the URDF's. Empty where the frame of the table is not known in R0.
std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, campaign::PointFrame table_frame);

}  // namespace stiffscope::frames
