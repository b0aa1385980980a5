#pragma once

#include "core/robot/kinematics.h"

namespace stiffscope::compensation {

/// The step of the joints that makes a small motion (m, then rotation vector, rad) of a point of the flange, J its
/// Jacobian there (6 x n).
///
/// n = 6: dq = J^-1 e.
/// n > 6: many steps make the motion. Of what the joints are then moved by altogether, `so_far` before the step, it
/// leaves the least sum of squares: so_far + dq = J^+ (e + J so_far), J^+ = J^T (J J^T)^-1.
/// n < 6: the position first, dq_p = J_p^+ e_p, J_p the first three rows; the freedom that this leaves, P = I - J_p^+
/// J_p, puts the orientation as right as it can: dq = dq_p + P w, |e_o - J_o (dq_p + P w)| least. Of the orientation
/// something is left.
JointVector jointStep(const Jacobian& jacobian, const Vector6d& motion, const JointVector& so_far);

/// How near a posture is to where jointStep fails: robot::conditioningAt; of fewer than six joints also the same ratio
/// of the first three rows alone, if that is less. Lengths over 1 m.
double stepConditioning(const robot::ArmAxes& axes, const Eigen::Vector3d& point_in_base);

}  // namespace stiffscope::compensation
