#pragma once

#include <cstddef>

namespace stiffscope {

/// Asks for large pages for memory that is about to be filled for the first time, where the system has them: each page of
/// four kilobytes that is touched costs its attention, a quarter of the time that reading a million rows takes. Changes
/// nothing but the time; of less than a few megabytes not even that.
void askForLargePages(void* begin, std::size_t bytes);

}  // namespace stiffscope
