#pragma once

#include <fmt/format.h>

#include <string>

namespace stiffscope {

/// `value` for printing with `decimals` places: what rounds to zero is zero, without the sign that would
/// print as -0.000.
inline double unsignedZero(double value, int decimals) {
  const std::string printed = fmt::format("{:.{}f}", value, decimals);
  return printed.find_first_of("123456789") == std::string::npos ? 0.0 : value;
}

}  // namespace stiffscope
