#include "reports/page/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stiffscope::page {

namespace {

constexpr const char* kNoNumber = "–";

std::string withMinus(const std::string& digits) {
  if (digits.empty() || digits.front() != '-') return digits;
  const std::string rest = digits.substr(1);
  // What rounds to zero has no sign.
  return rest.find_first_of("123456789") == std::string::npos ? rest : fmt::format("−{}", rest);
}

int exponentOf(double value) {
  return value == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
}

/// Decimal places that show `digits` significant digits of a value once it is rounded to them.
int placesFor(double value, int digits) {
  const int places = digits - 1 - exponentOf(value);
  const double unit = std::pow(10.0, -places);
  return digits - 1 - exponentOf(std::round(value / unit) * unit);
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return kNoNumber;
  if (decimals >= 0) return withMinus(fmt::format("{:.{}f}", value, decimals));
  const double unit = std::pow(10.0, -decimals);
  return withMinus(fmt::format("{:.0f}", std::round(value / unit) * unit));
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return kNoNumber;
  if (value == 0.0) return "0";
  if (std::abs(value) < 1e7) return fixed(value, placesFor(value, digits));
  const int exponent = exponentOf(value);
  return withMinus(fmt::format("{:.{}f}e{}", value / std::pow(10.0, exponent), digits - 1, exponent));
}

std::string withUncertainty(double value, double standard_uncertainty) {
  if (!std::isfinite(value)) return kNoNumber;
  if (!std::isfinite(standard_uncertainty) || standard_uncertainty <= 0.0) return significant(value, 4);
  if (std::max(std::abs(value), standard_uncertainty) >= 1e7) {
    return fmt::format("{} ± {}", significant(value, 2), significant(standard_uncertainty, 2));
  }
  const int places = placesFor(standard_uncertainty, 2);
  return fmt::format("{} ± {}", fixed(value, places), fixed(standard_uncertainty, places));
}

std::string toPlaceOf(double value, double width) {
  if (!std::isfinite(width) || width <= 0.0 || std::abs(value) >= 1e7) return significant(value, 4);
  return fixed(value, placesFor(width, 2));
}

std::string asPrinted(double value) { return withMinus(fmt::format("{}", value)); }

std::string percent(double share, int decimals) {
  return std::isfinite(share) ? fmt::format("{}\u00a0%", fixed(100.0 * share, decimals)) : kNoNumber;
}

}  // namespace stiffscope::page
