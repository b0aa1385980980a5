#pragma once

#include <string>
#include <vector>

#include "core/identification/geometric_stiffness_cost.h"
#include "core/identification/identify.h"
#include "core/identification/load_dependence.h"
#include "core/identification/posture_stiffness.h"

namespace stiffscope::reports {

/// The result of `identify` for a terminal.
std::string identificationText(const campaign::Campaign& campaign, const identification::Identification& result,
                               const std::vector<identification::Method>& methods);

/// Joints whose interval is wide or open, a line each: there a symmetric uncertainty of the stiffness misleads.
std::string wideIntervals(const identification::Identification& result, const std::vector<identification::Method>& methods);

/// Percentile intervals of the bootstrap beside the stated ones; empty where there is none.
std::string bootstrapText(const identification::Identification& result, const std::vector<identification::Method>& methods);

/// Stiffness by load step and whether it depends on the load.
std::string stepsText(const identification::StepStudy& study, const identification::Identification& result, const std::vector<identification::Method>& methods);

/// Conditioning, softest and stiffest direction at P_TCP, and what neglecting K_c costs, a line a posture.
std::string posturesText(const campaign::Campaign& campaign, const identification::Identification& result, identification::Method method);

}  // namespace stiffscope::reports
