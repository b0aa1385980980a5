#pragma once

#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// Decoupled Partial Pose (the paper's): the displacement of P_wrist sees only joints 1-3.
/// `wrist_equations` are those of P_wrist (J_Pwrist), `reflector_equations` those of P10, P11, P12 (J_P10,
/// J_P11, J_P12): the four Jacobians of (41). First c_1..c_3 by least squares from P_wrist, (32)-(35); then
/// the arm's model (38) is subtracted from each reflector's displacement (37); then c_4..c_6 from the rest,
/// (36). The torque is the same whether the wrench is carried to P_wrist, as the paper does, or not (a test).
StiffnessEstimate decoupledPartialPose(const std::vector<CaseEquations>& wrist_equations,
                                       const std::vector<CaseEquations>& reflector_equations,
                                       const JointMask& unknown);

/// The two stages on summed normal equations; for subsets of postures.
Vector6d solveDecoupled(const NormalEquations& wrist_sum, const NormalEquations& reflector_sum,
                        const JointMask& unknown);

}  // namespace stiffscope
