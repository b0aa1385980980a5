#pragma once

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/base_frame.h"
#include "core/frames/gravity_sag.h"
#include "core/frames/joint_axes.h"
#include "metrology/remark.h"
#include "metrology/rigid_motion.h"
#include "metrology/sphere_fit.h"

namespace stiffscope::frames {

/// One row of the paper's Table I.
struct WristTableRow {
  int target = 0;
  Eigen::Vector3d centre_in_r0 = Eigen::Vector3d::Zero();  ///< of the sphere of this reflector's own sweep, m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of the centre, by its own readings; R0 axes, m^2
  double radius = 0.0;                                     ///< m
  double offset = 0.0;                                     ///< distance of this centre from the mean of the centres, m
  double rms = 0.0;                                        ///< radial residuals of this reflector's sphere, m
  int readings = 0;
};

/// Two consecutive axes of the wrist, which should meet.
struct WristAxesMiss {
  int first = 0;          ///< the first of them, from 0
  double distance = 0.0;  ///< m
  double sd = 0.0;        ///< standard uncertainty (FramesCovariance); 0 where the axes were not measured
};

/// The wrist centre, where the last robot::wristJointsOf axes meet, by the wrist sweep (paper, II.D). The joints before
/// them are the arm's: 1-3 of six.
struct WristCentre {
  bool measured = false;
  Remark reason;
  JointVector q;                                           ///< the arm's joints during the sweep, the wrist's at zero
  Eigen::Vector3d centre_in_r0 = Eigen::Vector3d::Zero();  ///< common centre of all spheres, at q
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of it, with R0's (FramesCovariance); R0 axes, m^2
  Eigen::Vector3d centre_at_zero_in_r0 = Eigen::Vector3d::Zero();  ///< with the arm's joints turned back to zero
  std::vector<double> radii;  ///< |P_wrist P1X| by target; NaN for a target that was not swept
  /// In R0 as it is measured: its covariance is that of the wrist sweep's readings and of the station's pose.
  metrology::SphereFit spheres;
  Eigen::Matrix3d by_station = Eigen::Matrix3d::Zero();  ///< of it by that pose, which moves all spheres alike, m^2
  std::vector<int> targets;                              ///< of the spheres
  std::vector<WristTableRow> table;                      ///< Table I
  Eigen::Vector3d table_mean_in_r0 = Eigen::Vector3d::Zero();
  /// Covariance of the mean: the rows' readings are independent of each other, R0 and the station's pose are common to
  /// them. R0 axes, m^2.
  Eigen::Matrix3d table_mean_covariance = Eigen::Matrix3d::Zero();

  // Side by side with the sphere centre, all at q (docs/method.md, Wrist centre).
  Eigen::Vector3d reflector_barycentre_in_r0 = Eigen::Vector3d::Zero();  ///< Dumas et al.
  /// Middle of the common perpendicular of the last two axes.
  Eigen::Vector3d nearest_last_axes_in_r0 = Eigen::Vector3d::Zero();
  /// From the wrist's first axis on: of axes 4 and 5, 5 and 6 of six.
  PerJoint<WristAxesMiss> misses;
  /// Of a wrist of three axes: how far along the second one meets the third from where it meets the first, m. No wrist
  /// has a centre whose axes meet two and two at places of their own, as those of an arm with an offset wrist do.
  double apart = 0.0;
  bool offset() const { return apart > kOffsetWrist; }
  static constexpr double kOffsetWrist = 2e-3;  ///< m: ten times what wrists are made to
};

/// Fits concentric spheres to the wrist sweep, on the readings referred to the rigid arm.
/// Not measured, with the reason, without a sweep, without R0 in the sweep's frame, or where the fit is undetermined.
WristCentre measureWristCentre(const campaign::Campaign& campaign, const ArmInR0& arm, const RigidPoints& points,
                               const std::vector<std::optional<Eigen::Vector3d>>& targets_at_zero);

/// Distance and angle between two consecutive joint axes at zero.
struct LinkGeometry {
  double distance = 0.0;       ///< m
  double angle = 0.0;          ///< rad, 0..pi/2
  bool near_parallel = false;  ///< within a degree: `distance` is that across the first axis at `at_point`
  Eigen::Vector3d at_point_in_r0 = Eigen::Vector3d::Zero();  ///< on the first axis; only meant for near_parallel
  /// Standard uncertainties by FramesCovariance; empty where an axis was not measured.
  std::optional<double> distance_sd, angle_sd;
  double distance_sag_sd = 0.0;  ///< part of distance_sd by the stiffnesses with which the sag was corrected for, m
  double distance_by_sag =
      0.0;  ///< how far correcting for the sag moved the distance, m: an error of its model is of this
  double nominal_distance = 0.0;  ///< of the URDF, by the same rule
  double nominal_angle = 0.0;
};

/// [i] the one between axes i+1 and i+2: one fewer than axes.
using Links = boost::container::static_vector<LinkGeometry, kMostJoints - 1>;

/// Link i between axes i+1 and i+2 of the arm (paper, II.D: link lengths by circle-point). For axes within a degree of
/// parallel the common perpendicular's place is undetermined: their distance is taken in the plane normal to the first,
/// at the foot on it of the common perpendicular with the axis before (Hayati). For three axes within a degree of
/// parallel that foot is undetermined too, kilometres away: there the point of the axis before is carried over.
Links linkGeometry(const robot::Robot& nominal, const ArmInR0& arm);

/// Where on axis `first` the distance to a nearly parallel next one is taken, see linkGeometry.
Eigen::Vector3d hayatiPoint(const robot::ArmAxes& axes, std::size_t first);

/// What the sweeps give as one vector, of so many axes, in the order
///   error of R0: rotation vector, origin (FrameError: R0 as measured against the true one, in R0's axes),
///   distances, then angles between consecutive axes, one fewer than axes of each,
///   the wrist centre at the wrist sweep's posture, in R0 as measured,
///   the radius of each target of the campaign;
/// rad and m.
struct FramesLayout {
  static constexpr Eigen::Index kR0 = 0, kDistances = 6;
  Eigen::Index links, angles, wrist_centre, radii;  ///< links: how many; the others: where they start

  constexpr explicit FramesLayout(int axes)
      : links(axes - 1), angles(kDistances + links), wrist_centre(angles + links), radii(wrist_centre + 3) {}
  constexpr Eigen::Index count(std::size_t targets) const { return radii + static_cast<Eigen::Index>(targets); }
};

/// Joint covariance of what the sweeps give, with everything that they have in common: R0 in all that is expressed in
/// it, an axis in the two links that it ends, the sag's stiffnesses in everything. In the order of FramesLayout; rows
/// of what was not measured are zero.
struct FramesCovariance {
  Eigen::MatrixXd readings;  ///< by the noise of the sweeps' readings
  Eigen::MatrixXd sag;       ///< by the covariance of the stiffnesses with which the sag was corrected for
  Eigen::VectorXd by_scale;  ///< how a relative error of the tracker's scale, common to all readings, moves each

  /// How one declared standard uncertainty of the URDF's masses, common to all, moves each through the sag.
  Eigen::VectorXd by_masses;
  /// By what could deflect besides joint springs under the gravity load (extended_model::hiddenFrames); empty: not
  /// weighed.
  Eigen::MatrixXd hidden;
  /// Relative standard uncertainty of the tracker's scale as declared; 1 K of air temperature that is not known makes
  /// 1e-6 (Edlen's equation of the refractive index of air).
  double scale_sd = 0.0;

  Eigen::MatrixXd total() const;
  metrology::FrameCovariance r0() const { return total().topLeftCorner<6, 6>(); }
};

/// By the law of propagation (GUM 5.2.2), with `sag` zero. FramesLayout::count of the campaign's targets; all zero
/// where R0 is not placed in the frame of the readings. `station`: the tracker's, in that frame.
FramesCovariance framesCovariance(const MeasuredAxes& axes, const ArmInR0& arm, const Links& links,
                                  const WristCentre& wrist, std::size_t targets, const Eigen::Vector3d& station);

/// Puts the standard uncertainties into links and wrist.
void stateUncertainties(const FramesCovariance& covariance, const MeasuredAxes& axes, const ArmInR0& arm, Links& links,
                        WristCentre& wrist);

/// Where each reflector would stand in R0 with all joints at zero: the mean of its sweep readings, referred to the
/// rigid arm and turned back by their joint angles. Where a target's place on the flange is declared and no
/// reading shows it, that place. Empty for a target that neither gives.
std::vector<std::optional<Eigen::Vector3d>> targetsAtZero(const campaign::Campaign& campaign, const ArmInR0& arm,
                                                          const RigidPoints& points);

/// Everything the sweeps give (paper, II.D): axes, R0, the arm in R0, link lengths, P_TCP, the wrist centre.
struct Frames {
  MeasuredAxes axes;
  ArmInR0 arm;
  campaign::PointFrame points_frame = campaign::PointFrame::tracker;  ///< the frame of the sweeps' readings
  Links links;
  std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero;
  WristCentre wrist;
  /// P_TCP: where the last axis pierces the plane z = 0 of the flange; the flange's origin where the axis runs within
  /// ten degrees of that plane, as with an angled tool, and would pierce it anywhere.
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();
  bool tcp_at_origin = false;       ///< because of that
  robot::GravityLoad weight;        ///< in R0
  bool sag_removed = false;         ///< readings were referred to the rigid arm
  double largest_sag = 0.0;         ///< largest correction of a reading of the sweeps, m
  Remark sag_note;                  ///< why not, or with which stiffnesses
  bool sag_in_uncertainty = false;  ///< what is not taken off, or how well, is in `covariance`
  FramesCovariance covariance;      ///< of R0, links and wrist; the arm's own sag is in it as far as stiffnesses tell

  // In frames.cpp, for the build's sake as of robot::Robot.
  Frames();
  Frames(const Frames&);
  Frames(Frames&&) noexcept;
  Frames& operator=(const Frames&);
  Frames& operator=(Frames&&) noexcept;
  ~Frames();
};

/// With the arm taken as rigid under its own weight.
Frames measureFrames(const campaign::Campaign& campaign);

/// Measures again with the readings corrected for the sag by these joint compliances (rad/Nm) and the arm as measured
/// so far, which has to be of the same sweeps. Its error is that of `so_far` shrunk about a thousandfold. Where masses
/// are not known, `so_far` with a note. `covariance` of the compliances, where it is given and finite, is propagated
/// into that of the frames, by differences of the whole measurement. It knows nothing of what is wrong with a sag by
/// joint springs alone: bearings that deflect across their axes bend the arm too, and falsify the springs;
/// LinkGeometry::distance_by_sag shows the stake, and FramesCovariance::hidden weighs it.
Frames refineFrames(const campaign::Campaign& campaign, const Frames& so_far, const JointVector& compliance,
                    const std::optional<JointMatrix>& covariance = std::nullopt);

/// A joint of unknown stiffness turns by as much under the largest torque of the own weight in the sweeps, one standard
/// uncertainty, rad. A judgement: joints 2, 3 and 5 of the heavy arms in samples (stiffnesses near the paper's), and of
/// simulated arms of 20 to 500 kg, turn by 0.3 to 5.9 mrad, 2.7 rms.
inline constexpr double kTurnByOwnWeight = 3e-3;

/// Frames of sweeps to which no load gives stiffnesses: the sag is taken off by those that the campaign knows, with
/// their uncertainty; of a joint that it does not know what kTurnByOwnWeight does is in the covariance (GUM 4.3, type
/// B). `so_far` as it is where masses are not known or R0 is not placed.
Frames refineByKnownStiffness(const campaign::Campaign& campaign, const Frames& so_far);

/// How the numbers of FramesLayout differ between two measurements of the same sweeps, in their order.
Eigen::VectorXd framesDifference(const Frames& from, const Frames& to);

/// The sag of the arm as `frames` have it, by these joint compliances (rad/Nm).
SagModel sagOf(const Frames& frames, const JointVector& compliance);

/// The frames by these sweeps, already referred to the rigid arm, less `frames`: the numbers of FramesLayout in their
/// order. The campaign has the tables and targets that `frames` was measured from.
Eigen::VectorXd framesChange(const campaign::Campaign& campaign, const RigidPoints& points, const Frames& frames);

/// r0_from_points for a table: the measured frame for readings in the sweeps' frame; for readings in base_link with
/// sweeps by the tracker, or none, the URDF's. Empty where the frame of the table is not known in R0.
std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, campaign::PointFrame table_frame);

}  // namespace stiffscope::frames
