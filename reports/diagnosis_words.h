#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnosis.h"

namespace stiffscope {

/// "bearing_tilt or link_compliance".
std::string effectNames(const std::vector<Effect>& effects);

/// What is present, in one line: "hysteresis (joint 2), and unknown"; "none" where nothing is.
std::string verdictWords(const Verdict& verdict);

}  // namespace stiffscope
