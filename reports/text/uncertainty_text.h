#pragma once

#include <string>

#include "core/cartesian_stiffness/posture_stiffness.h"
#include "core/identification/by_step.h"
#include "core/identification/geometric_stiffness_cost.h"

namespace stiffscope {

/// Joints whose interval is wide or open, a line each: there a symmetric uncertainty of the stiffness misleads.
std::string wideIntervals(const Identification& result, const std::vector<Method>& methods);

/// Percentile intervals of the bootstrap beside the stated ones; empty where there is none.
std::string bootstrapText(const Identification& result, const std::vector<Method>& methods);

/// Stiffness by load step and whether it depends on the load.
std::string stepsText(const StepStudy& study, const Identification& result, const std::vector<Method>& methods);

/// Conditioning, softest and stiffest direction at P_TCP, and what neglecting K_c costs, a line a posture.
std::string posturesText(const Campaign& campaign, const Identification& result, Method method);

}  // namespace stiffscope
