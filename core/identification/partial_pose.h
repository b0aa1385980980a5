#pragma once

#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// Partial Pose equations of one load case (Wu, Klimchik et al.; paper (40), read with K^-1): the
/// displacements of the reflectors only, three rows each in the order of load_case.targets, m. J_m at the
/// reflector as measured (jacobianPoint).
CaseEquations partialPoseEquations(const LoadCase& load_case, const Vector6d& torque);

/// All six compliances at once. `normal`: normalByPosture(equations).
StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations,
                              const std::vector<NormalEquations>& normal, const JointMask& unknown);
StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations, const JointMask& unknown);

}  // namespace stiffscope
