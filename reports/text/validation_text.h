#pragma once

#include <string>

#include "core/validation/run_blind.h"

namespace stiffscope::reports {

/// The rates and, effect by effect, how many were answered right, for a terminal.
std::string blindText(const validation::BlindResult& result);

}  // namespace stiffscope::reports
