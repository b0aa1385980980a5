#include "core/io/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace stiffscope::io {

namespace {

// from_chars takes no '+'; "+-1" stays wrong, because only one sign is removed and '-' may not follow it.
std::string_view withoutPlus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

bool hasDigit(std::string_view text) { return text.find_first_of("0123456789") != std::string_view::npos; }

// 27.11.2026, 2026-11-27T08:00:00, 11/27/2026, 08:00:00.
bool isDateOrClock(std::string_view text) {
  if (!hasDigit(text)) return false;
  if (text.find(':') != std::string_view::npos) return true;
  const auto parts = [&](char mark) {
    return std::count(text.begin() + 1, text.end(), mark) == 2;  // a sign is no mark
  };
  const bool number = text.find_first_of(",eE") != std::string_view::npos;
  // A point that was typed twice is no date: those have a year of two digits or four behind it.
  const std::size_t year = text.substr(0, text.find_first_of(" T")).size() - text.rfind('.') - 1;
  return !number && (parts('-') || parts('/') || (parts('.') && (year == 2 || year == 4)));
}

// 1,234.5 or 1.234,5 or 1,234,567: one mark is of thousands.
bool hasThousandsMark(std::string_view text) {
  const auto commas = std::count(text.begin(), text.end(), ','), points = std::count(text.begin(), text.end(), '.');
  return commas > 1 || (commas == 1 && points > 0);
}

// What people and programs write that is a number to them.
std::string whyNoNumber(std::string_view text) {
  if (text.empty()) return "expected a number; there is nothing";
  if (text.find("${") != std::string_view::npos) return "expected a number; expand xacro first";
  if (isDateOrClock(text)) return "expected a number; a date or a clock time is none, times are in seconds";
  if (hasThousandsMark(text)) {
    return "expected a number with a decimal point, and without a mark between thousands";
  }
  if (text.find(',') != std::string_view::npos) {
    return "expected a number with a decimal point, not a decimal comma";
  }
  if (text.find("\xE2\x88\x92") != std::string_view::npos || text.find("\xE2\x80\x93") != std::string_view::npos) {
    return "expected a number; its minus sign is a typographic one, write '-'";
  }
  if (!hasDigit(text)) return "expected a number";
  if (text.find_first_of("xX") != std::string_view::npos) return "expected a number, decimal and not hexadecimal";
  if (text.find_first_of("dD") != std::string_view::npos) {
    return "expected a number; an exponent is written with e, not with d";
  }
  if (text.find_first_of(" '\t") != std::string_view::npos || text.find("\xC2\xA0") != std::string_view::npos) {
    return "expected a number without blanks or marks between its digits";
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

double numberOrNan(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<int> parseInteger(std::string_view text) {
  int value = 0;
  const std::string_view digits = withoutPlus(text);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

}  // namespace stiffscope::io
