#pragma once

#include <string>

#include "core/blind/run_blind.h"

namespace stiffscope {

/// The rates and, effect by effect, how many were answered right, for a terminal.
std::string blindText(const blind::BlindResult& result);

}  // namespace stiffscope
