#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/identification/estimate.h"
#include "metrology/remark.h"

namespace stiffscope::identification {

// The gear of a joint by its two encoders: no tracker takes part.
//
// Joint i from the motor outwards: the motor, its angle over the gear ratio m; the gear, a torsional spring c_g =
// 1/k_g; the second encoder, which reads the link-side angle q; bearings and link, which give by c_s as far as that is
// a turn about the axis. A load puts tau = (J_w^T W)_i on the link, in the sense of positive q. The gear pulls the link
// back by k_g (q - m), so that at rest
//
//   tau - k_g (q - m) = 0,   q - m = c_g tau:
//
// the link runs ahead of its motor in the sense of the load. This does not ask what the controller holds still; what
// the tracker sees does. Closed on the link side (double encoder active) the loop turns the motor back by c_g tau, q
// stays, and the tracker sees c_s alone. Closed on the motor (inactive) m stays, q moves on by c_g tau, and the tracker
// sees the two in series, c_s + c_g.
//
// In the states s of a posture p the wind-up is read as
//
//   (q - m)_ps = a_p + c_g tau_ps + w/2 sign(T_ps) + e_ps.
//
// a_p is the encoders' zero and the wind-up by the own weight at that posture, and drops out of differences within it.
// tau is the load's torque with K_c (equations.h), T that of load and own weight together, w the lost motion of the
// gear: it shows where a load turns T round, and is fitted where masses are known and three postures or more do that.
// c_g comes from least squares after a first slope that single wrong readings do not move (the weighted median over
// pairs of states, Theil and Sen), from which such readings are left out.
//
// Frames: R0, as the torques of the methods. Units: rad, Nm, rad/Nm.

/// Which of a gear's sides stands still under load.
enum class HeldSide { unknown, link, motor };

/// As the campaign declares its loops.
HeldSide declaredSide(campaign::DoubleEncoder declared);

/// Half the distance between the two branches of a gear, by the sign of its torque.
struct LostMotion {
  double width = 0.0;  ///< rad in all
  double sd = 0.0;     ///< by the scatter between postures
};

/// What the two encoders of a joint tell.
struct GearTorsion {
  bool measured = false;  ///< the estimate has an entry
  Remark reason;          ///< why not
  Remark caution;         ///< what to know before believing it; mostly empty
  int states = 0;         ///< used
  int postures = 0;       ///< with two of them or more
  int left_out = 0;       ///< states that disagree with the rest
  HeldSide held = HeldSide::unknown;
  double link_turn = 0.0;     ///< of the link side under load, q's slope over the torque, rad/Nm: 0 where q is held
  double link_turn_sd = 0.0;  ///< by the scatter between postures
  double offset = 0.0;        ///< q - m without torque, mean over postures, rad
  double offset_sd = 0.0;     ///< standard deviation between postures
  bool offset_holds_weight = false;  ///< masses are not known: the wind-up by the own weight is in the offset
  double rms_residual = 0.0;         ///< of the used states, over degrees of freedom, rad
  double rms_torque = 0.0;           ///< of the load, between the states of a posture, Nm
  std::optional<LostMotion> lost_motion;
};

/// A state of a joint as the fit sees it.
struct TorsionPoint {
  int pose = 0;
  int step = 0;
  int joint = 0;          ///< from 0
  double torque = 0.0;    ///< of the load, Nm
  double torsion = 0.0;   ///< q - m less a_p, rad
  double residual = 0.0;  ///< of it, rad
  bool used = true;
};

/// Compliances of the gears, as the methods' estimates: interval, uncertainty and marks are those of estimate.h. The
/// covariance has the scatter between postures, the measured axes, and in `parts.effects` the declared scale of the
/// load cell.
struct Transmission {
  PerJoint<GearTorsion> joints;
  StiffnessEstimate estimate;
  std::vector<TorsionPoint> points;  ///< by joint, pose, step

  bool measured() const;  ///< of any joint
};

/// Whether `states` has motor-side angles of any joint that differ from the reported ones: a joint whose columns are
/// blank, or equal to q everywhere, has no second encoder.
bool hasSecondEncoders(const campaign::Campaign& campaign);

/// Compliances of the gears in a geometry, and their covariance where what the geometry was measured by is uncertain.
using GearsIn = std::function<JointVector(const frames::LoadingGeometry&)>;
using GeometryPart = std::function<JointMatrix(const GearsIn&)>;

/// The gears of a campaign that has second encoders, states and a load cell; `compliance`: of the joints as the tracker
/// sees them, for K_c; zero where it is not known. `by_axes`: what the measured axes share with all postures; empty:
/// they count as known. Joints that cannot be measured say why; it never throws for what the data lacks.
Transmission measureTransmission(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                 const JointVector& compliance, const GeometryPart& by_axes = {});

/// How the gear by its encoders and the joint by the tracker go together.
enum class GearAgreement {
  apart,           ///< not in series: the tracker does not see the gear, nothing to hold against each other; or an
                   ///< uncertainty is open
  structure_seen,  ///< in series, and the structure's interval is above zero
  gear_alone,      ///< in series, and no structure besides the gear is seen: the two agree
  contradicts      ///< in series, and the gear alone gives more than the tracker sees in all
};

/// Gear and structure of one joint apart: c_s = c - c_g in series, else c_s = c, c the compliance by the tracker.
struct GearAndStructure {
  bool in_series = false;
  double structure = 0.0;     ///< c_s, rad/Nm
  double sd = 0.0;            ///< of it; the two measurements count as independent, which the load cell's scale is not:
                              ///< in series that overstates
  CoverageInterval interval;  ///< of it, 95 %: the distances of both intervals' ends, squares added
  double gear_share = 0.0;    ///< c_g / (c_g + c_s)
  GearAgreement agreement = GearAgreement::apart;
};

/// Empty where one of the two is not measured or it is not known which side is held.
std::optional<GearAndStructure> gearAndStructure(const Transmission& transmission, const StiffnessEstimate& by_tracker,
                                                 int joint);

}  // namespace stiffscope::identification
