#pragma once

#include <string>

namespace stiffscope::page {

/// A text of core with its units as people write them: um as µm, urad as µrad, +- as ±, chi2 as χ². Only
/// whole words are changed.
std::string withMicro(const std::string& text);

}  // namespace stiffscope::page
