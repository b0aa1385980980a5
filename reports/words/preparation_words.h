#pragma once

#include <string>

#include "core/preparation/prepare.h"

namespace stiffscope::reports {

/// Ends the source of every limit by chance; a page says it once.
inline constexpr const char* kChanceIsShared = "; 1 % false findings over the whole audit, shared by all that is tried";

/// What was done to the readings, in sentences: how many were left out and which drift was corrected for, or
/// why none; "raw" where that was asked for.
std::string preparationWords(const preparation::Preparation& preparation);

/// The same for people, wrapped, with file, line and reason of each rejected reading (of the first ten) on
/// a line of its own.
std::string preparationText(const preparation::Preparation& preparation);

/// "loading.csv:100: lost beam: the point is (0, 0, 0)"
std::string rejectedWords(const preparation::RejectedReading& reading);

}  // namespace stiffscope::reports
