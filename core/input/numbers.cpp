#include "core/input/numbers.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace stiffscope {

namespace {

// from_chars takes no '+'; "+-1" stays wrong, because only one sign is removed and '-' may not follow it.
std::string_view withoutPlus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

bool hasDigit(std::string_view text) { return text.find_first_of("0123456789") != std::string_view::npos; }

// What people and programs write that is a number to them.
std::string whyNoNumber(std::string_view text) {
  if (text.empty()) return "expected a number; there is nothing";
  if (text.find("${") != std::string_view::npos) return "expected a number; expand xacro first";
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

constexpr std::size_t kMostDigits = 15;
constexpr double kPowersOfTen[kMostDigits + 1] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A factor, because a processor guesses signs wrong every other time.
double decimalNumber(bool minus, std::int64_t digits, std::size_t decimals) {
  static constexpr double kSign[2] = {1.0, -1.0};
  return static_cast<double>(digits) / kPowersOfTen[decimals] * kSign[minus ? 1 : 0];
}

/// Eight characters, the first in the lowest byte, each less '0'.
std::uint64_t eightFrom(const char* first) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, first, sizeof eight);
  return eight ^ 0x3030303030303030ull;
}

/// The high bit of the first byte that is no digit, and of some behind it; 0 where all eight are digits.
std::uint64_t notDigits(std::uint64_t eight) {
  return ((eight + 0x7676767676767676ull) | eight) & 0x8080808080808080ull;
}

/// The number that eight digits are: of two each, of four each, of all.
std::int64_t valueOf(std::uint64_t eight) {
  eight = 10 * eight + (eight >> 8);
  const std::uint64_t odd = eight & 0x000000ff000000ffull, even = (eight >> 16) & 0x000000ff000000ffull;
  return static_cast<std::int64_t>((odd * 0x000f424000000064ull + even * 0x0000271000000001ull) >> 32);
}

/// parsePlainNumber of 1 to 7 digits, a point and 1 to 8 digits: what tables hold by the million. Digits are taken eight
/// at a time, and which character is the point is found without a branch that the processor would have to guess.
double parseEightAtOnce(std::string_view text) {
  if (std::endian::native != std::endian::little || text.empty()) return kNone;
  const bool minus = text[0] == '-';
  const char* const first = text.data() + (minus ? 1 : 0);
  const std::size_t size = text.size() - (minus ? 1 : 0);
  const std::uint64_t whole = eightFrom(first);
  const auto digits = static_cast<std::size_t>(std::countr_zero(notDigits(whole))) / 8;
  if (digits < 1 || digits > 7 || digits + 2 > size || size > digits + 9 || first[digits] != '.') return kNone;
  const std::size_t decimals = size - digits - 1;
  const std::uint64_t fraction = eightFrom(first + digits + 1) << 8 * (8 - decimals);
  if (notDigits(fraction) != 0) return kNone;
  static constexpr std::int64_t kShift[9] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  return decimalNumber(minus, valueOf(whole << 8 * (8 - digits)) * kShift[decimals] + valueOf(fraction), decimals);
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

double parsePlainNumber(std::string_view text, bool room_behind) {
  if (room_behind) {
    const double value = parseEightAtOnce(text);
    if (!std::isnan(value)) return value;
  }
  const bool minus = !text.empty() && text[0] == '-';
  std::int64_t digits = 0;
  std::size_t count = 0, decimals = 0;
  bool point = false;
  for (std::size_t i = minus ? 1 : 0; i < text.size(); ++i) {
    const auto digit = static_cast<unsigned char>(text[i] - '0');
    if (digit > 9) {
      if (text[i] != '.' || point) return kNone;
      point = true;
      continue;
    }
    digits = 10 * digits + digit;
    decimals += point ? 1 : 0;
    if (++count > kMostDigits) return kNone;
  }
  if (count == 0) return kNone;
  return decimalNumber(minus, digits, decimals);
}

std::optional<int> parseInteger(std::string_view text) {
  int value = 0;
  // Steps, of which a table has many, have a digit or two.
  constexpr std::size_t kFew = 4;
  if (!text.empty() && text.size() <= kFew) {
    bool plain = true;
    for (const char c : text) {
      plain = plain && c >= '0' && c <= '9';
      value = 10 * value + (c - '0');
    }
    if (plain) return value;
  }
  const std::string_view digits = withoutPlus(text);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

}  // namespace stiffscope
