#pragma once

#include "core/identification/estimate.h"

namespace stiffscope::identification {

/// Partial Pose equations of one load case (Wu, Klimchik et al.; paper (40), read with K^-1): the
/// displacements of the reflectors only, three rows each in the order of load_case.targets, m. J_m at the
/// reflector as measured (jacobianPoint).
CaseEquations partialPoseEquations(const LoadCase& load_case, const JointVector& torque);

/// All compliances at once. `normal`: normalByPosture(equations).
StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations, const std::vector<NormalEquations>& normal,
                              const robot::JointMask& unknown);
StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations, const robot::JointMask& unknown);

}  // namespace stiffscope::identification
