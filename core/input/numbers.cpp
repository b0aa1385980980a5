#include "core/input/numbers.h"

#include <charconv>
#include <cmath>

namespace stiffscope {

namespace {

// from_chars takes no '+'; "+-1" stays wrong, because only one sign is removed and '-' may not follow it.
std::string_view withoutPlus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

std::string whyNoNumber(std::string_view text) {
  if (text.empty()) return "expected a number; there is nothing";
  if (text.find("${") != std::string_view::npos) return "expected a number; expand xacro first";
  if (text.find(',') != std::string_view::npos) {
    return "expected a number with a decimal point, not a decimal comma";
  }
  return "expected a number";
}

}  // namespace

ParsedNumber parseNumber(std::string_view text) {
  const std::string_view digits = withoutPlus(text);
  ParsedNumber number;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number.value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
    number.expectation = whyNoNumber(text);
  } else if (error == std::errc::result_out_of_range) {
    number.expectation = "expected a number that double precision can hold";
  } else if (!std::isfinite(number.value)) {
    number.expectation = "expected a finite number";
  }
  return number;
}

std::optional<int> parseInteger(std::string_view text) {
  const std::string_view digits = withoutPlus(text);
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

}  // namespace stiffscope
