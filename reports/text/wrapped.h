#pragma once

#include <string>

namespace stiffscope {

/// Text broken at blanks to lines of at most 98 columns, those after the first indented by `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent);

}  // namespace stiffscope
