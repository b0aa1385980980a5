#pragma once

#include <string>

#include "core/interchange/point_reading.h"

namespace stiffscope::reports {

/// Why a row of a file is no reading, a part of a sentence.
std::string skipWords(interchange::Skip reason);

}  // namespace stiffscope::reports
