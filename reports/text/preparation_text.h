#pragma once

#include <string>

#include "core/audit/prepare.h"

namespace stiffscope {

/// What was done to the readings, in sentences: how many were left out and what drift was taken off, or why
/// none; "raw" where that was asked for.
std::string preparationWords(const Preparation& preparation);

/// The same for people, wrapped, with file, line and reason of each rejected reading (of the first twenty) on
/// a line of its own.
std::string preparationText(const Preparation& preparation);

/// "loading.csv:100: lost beam: the point is (0, 0, 0)"
std::string rejectedWords(const RejectedReading& reading);

}  // namespace stiffscope
