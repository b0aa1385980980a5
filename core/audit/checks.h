#pragma once

#include <vector>

#include "core/audit/audit_input.h"
#include "core/preparation/finding.h"
#include "metrology/axis_fit.h"

// The checks. Each takes the input and gives one or more findings; none changes anything. Lost beams,
// duplicates and outlying repeats are found beforehand (core/preparation/prepare.h), because the others work
// without them.

namespace stiffscope::audit {

/// The readings of one reflector while one axis turns, with their rows.
struct SweptCircle {
  int target = 0;
  metrology::CirclePoints readings;  ///< corrected for the sag where possible
  std::vector<std::size_t> lines;
};

/// Circles of each axis in the order in which MeasuredAxis has them.
using SweptCircles = PerJoint<std::vector<SweptCircle>>;
SweptCircles sweptCircles(const AuditInput& input);

/// Why no circles can be judged: no axis has any, as of an arm whose joints are coupled. Empty: some has.
Remark noCircles(const frames::MeasuredAxes& axes);

/// Standard uncertainty of an axis, the larger of its two directions.
struct AxisUncertainty {
  double direction = 0.0;  ///< rad
  double place = 0.0;      ///< m, on the axis at the middle of its circles
};

AxisUncertainty uncertaintyOf(const metrology::AxisFit& fit);

/// How much larger the uncertainty of direction and place is with `readings` evenly over `arc` (rad) than
/// with as many over 90 deg. Both depend on the arc through the same 2x2 matrix: radial residuals move with
/// the place as axial ones do with the direction, by cos and sin of the place on the circle, with a radius or
/// height to be found too.
double arcCost(double arc, int readings);

using Findings = std::vector<preparation::AuditCheck>;

/// time_order: within a posture, steps follow each other in time, the states' rows as well as the readings.
Findings checkTimeOrder(const AuditInput& input);

/// completeness: each posture has every step that most have, each state every reflector and repeat.
Findings checkCompleteness(const AuditInput& input);

/// repeatability_along, repeatability_across: scatter of the repeats against the declared noise.
Findings checkRepeatability(const AuditInput& input);

/// noise_declared, of the tracker and of the load cell: their declared noise against what the readings show
/// (core/audit/redundancies.h). Warns where too large, because all limits are then as lax; fails where too small.
Findings checkDeclaredNoise(const AuditInput& input);

/// rigid_tool: distances between reflectors, over sweeps, postures and loads.
Findings checkRigidTool(const AuditInput& input);

/// station_drift, nest_moved: the floor nests' motion as that of the station, and what is left as that of
/// nests. Of a day of several stations one station_drift a station, and stations_agree: whether the nests keep their
/// shape from one to the other.
Findings checkNests(const AuditInput& input);

/// circle_arc (one an axis: how far it was seen to turn by the reflector that was read farthest), circle_count: the
/// sweeps of each axis.
Findings checkCircleSweeps(const AuditInput& input);

/// sweep_angles: how far each axis turns by its reflectors, against what the joint reports. Fails beyond twice or half.
Findings checkSweepAngles(const AuditInput& input);

/// circle_residual: how the readings lie on their circles. This, axis_agreement and wrist_sphere leave open what a sag
/// does that is off by as much as it is uncertain (core/audit/sag_doubt.h).
Findings checkCircleResidual(const AuditInput& input);

/// axis_agreement, reflector_on_axis: what each reflector says of the axes it turns about.
Findings checkSweptReflectors(const AuditInput& input);

/// link_lengths: the measured distances between axes against the URDF's. Fails beyond kMissedGeometry: no machine is
/// built so far off its drawing.
Findings checkLinkLengths(const AuditInput& input);

/// wrist_sphere, wrist_axes_meet.
Findings checkWrist(const AuditInput& input);

/// rail_straight, rail_scale, rail_direction: how the carriage goes (core/preparation/rail.h) against a straight line,
/// what is reported and the URDF. None for an arm that stands on no rail.
Findings checkRail(const AuditInput& input);

/// frame_moved, unloaded_positions, joint_read_back: unloaded absolute positions against forward kinematics;
/// frame_moved from the sweeps to the loading, and during it.
Findings checkUnloadedPositions(const AuditInput& input);

/// servo_change: reported angles that change under load.
Findings checkServo(const AuditInput& input);

/// return_to_zero: reflectors back where step 0 had them once the load is off, by points or by displacements.
Findings checkReturnToZero(const AuditInput& input);

/// tare, gravity_direction, moment_lever.
Findings checkLoadCell(const AuditInput& input);

/// load_size: force over displacement, against what arms give (core/identification/warnings.h).
/// Fails where no arm is like that.
Findings checkLoadSize(const AuditInput& input);

/// posture_set: condition number, and joint by joint whether it can be identified or why not.
Findings checkPostureSet(const AuditInput& input);

/// arm_model, load_model: unloaded readings against the URDF's arm, loads against joint springs that give way
/// (core/mistakes/find_mistakes.h). Fail where they contradict it by more than machines do; both then are impossible.
/// load_model warns of single postures that contradict the springs of the others (core/identification/outliers.h).
Findings checkModel(const AuditInput& input);

/// controller_poses: the URDF's forward kinematics against the poses that the controller states
/// (core/mistakes/controller_agreement.h), and its declared model against what they show. Fails where one mistake
/// explains the difference or no machine is that far off its drawing, warns of another model than the URDF's.
Findings checkControllerPoses(const AuditInput& input);

}  // namespace stiffscope::audit
