#pragma once

#include <string>

#include "core/compensation/compensate.h"

namespace stiffscope::reports {

/// Why a posture, or a pose of a path, was refused, for many of them: "the load turns a joint of unknown stiffness".
std::string refusalWords(const Remark& reason);

/// "12 of 19 postures compensated, 3 of them with cautions; 7 refused: 5 because ..., 2 because ...".
std::string summaryWords(const compensation::CompensationSummary& summary);

}  // namespace stiffscope::reports
