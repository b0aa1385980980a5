#pragma once

#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// By how much each posture moves a method's compliances: the estimate from all postures less the estimate
/// without it, one vector a load case, rad/Nm (the jackknife's differences; B. Efron, The Jackknife, the
/// Bootstrap and Other Resampling Plans, 1982, chapter 3). The equations are those that `method` was solved
/// from last, so nothing is linearised but the finite deflection. Empty where the method is unavailable.
std::vector<Vector6d> moveByEachPosture(const Identification& result, Method method);

}  // namespace stiffscope
