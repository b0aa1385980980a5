#pragma once

#include <string>

#include "core/planning/plan.h"

namespace stiffscope::reports {

/// The result of `plan` for a terminal.
std::string planText(const campaign::Campaign& campaign, const planning::Plan& plan);

/// The planned postures as a CSV table: pose, q1_deg..q6_deg, the load-cell reading expected (as `compensate
/// --postures` takes it), and the pull's direction in base_link, pull_x..pull_z.
std::string planCsv(const planning::Plan& plan);

/// The same as the `postures` element of a simulation's specification.
std::string planXml(const planning::Plan& plan);

}  // namespace stiffscope::reports
