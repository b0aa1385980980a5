#pragma once

#include <cmath>

namespace stiffscope {

/// `value` for printing with `decimals` places: what rounds to zero is zero, without the sign that would
/// print as -0.000.
inline double unsignedZero(double value, int decimals) {
  return std::abs(value) <= 0.5 * std::pow(10.0, -decimals) ? 0.0 : value;
}

}  // namespace stiffscope
