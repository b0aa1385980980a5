#pragma once

#include "core/identification/estimate.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

/// Decoupled Partial Pose (the paper's): the displacement of P_wrist sees only the arm's joints, 1-3 of six
/// (robot::armJointsOf).
/// `wrist_equations` are those of P_wrist (J_Pwrist), `reflector_equations` those of P10, P11, P12 (J_P10,
/// J_P11, J_P12): the four Jacobians of (41). First the arm's, c_1..c_3, by least squares from P_wrist, (32) stacked as
/// (34) and (35); then the arm's model (38) is subtracted from each reflector's displacement (37); then the wrist's,
/// c_4..c_6, from the rest, (33) and (36). The torque is the same whether the wrench is carried to P_wrist, as the
/// paper does, or not (a test).
StiffnessEstimate decoupledPartialPose(const std::vector<CaseEquations>& wrist_equations,
                                       const std::vector<CaseEquations>& reflector_equations,
                                       const robot::JointMask& unknown);

/// The two stages on summed normal equations; for subsets of postures.
JointVector solveDecoupled(const NormalEquations& wrist_sum, const NormalEquations& reflector_sum,
                           const robot::JointMask& unknown);

/// Share of P_wrist's displacement that the wrist's joints may put there, because the wrist's axes miss each other,
/// before decoupling is refused: it takes that displacement for one of the arm's, so this is the error it
/// then carries into the arm's compliances.
inline constexpr double kWristLeakBorne = 0.02;

/// Share of P_wrist's displacement, over the load cases, that turning in the wrist's joints puts there: sum of
/// |J_m c tau| with the arm's c zero over sum of |displacement|. 0 for a wrist whose axes meet; also where P_wrist
/// is not measured. `centre_at_zero`: P_wrist at joints zero, R0, m; `compliance` in rad/Nm. The arm's
/// torques are those of its last solution.
double wristLeak(const LoadedArm& arm, const Eigen::Vector3d& centre_at_zero, const JointVector& compliance);

}  // namespace stiffscope::identification
