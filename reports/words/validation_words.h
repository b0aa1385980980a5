#pragma once

#include <string>

#include "core/validation/score.h"

namespace stiffscope::reports {

/// "1 to 2", "5 and more": sizes in noises.
std::string sizeWords(const validation::SizeClass& sizes);

}  // namespace stiffscope::reports
