#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

// Digits eight at a time, in one register. Inline: tables hold such numbers by the million.

namespace stiffscope::io {

/// Eight characters, the first in the lowest byte, each less '0'.
inline std::uint64_t eightFrom(const char* first) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, first, sizeof eight);
  return eight ^ 0x3030303030303030ull;
}

/// The high bit of the first byte that is no digit, and of some behind it; 0 where all eight are digits.
inline std::uint64_t notDigits(std::uint64_t eight) {
  return ((eight + 0x7676767676767676ull) | eight) & 0x8080808080808080ull;
}

/// Digits that a text of `size` characters begins with, eight at most; `eight`: of its first ones.
inline std::size_t leadingDigits(std::uint64_t eight, std::size_t size) {
  return std::min(static_cast<std::size_t>(std::countr_zero(notDigits(eight))) / 8, size);
}

/// The number that eight digits are: of two each, of four each, of all.
inline std::int64_t valueOf(std::uint64_t eight) {
  eight = 10 * eight + (eight >> 8);
  const std::uint64_t odd = eight & 0x000000ff000000ffull, even = (eight >> 16) & 0x000000ff000000ffull;
  return static_cast<std::int64_t>((odd * 0x000f424000000064ull + even * 0x0000271000000001ull) >> 32);
}

// Tables for the whole program: a table inside a function is made anew at every call where compilers fail to see that it
// never changes, and that took longer than the arithmetic.
inline constexpr double kPowersOfTen[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
inline constexpr std::int64_t kShifts[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

/// The value of -digits or +digits, `decimals` of them behind the point. Up to fifteen digits, and the power of ten, are
/// exact in double precision, so one division rounds correctly (Clinger, How to read floating point numbers accurately,
/// PLDI 1990).
inline double decimalNumber(bool minus, std::int64_t digits, std::size_t decimals) {
  const double magnitude = static_cast<double>(digits) / kPowersOfTen[decimals];
  // The sign's bit, because a processor guesses signs wrong every other time.
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) ^ (std::uint64_t{minus} << 63));
}

/// The value of a text of 1 to 7 digits, or of these, a point and 1 to 8 more, with '-' before them or without; NaN for
/// every other. Eight bytes behind the text must be there to be read, whatever they are. Which character is the point is found
/// without a branch that the processor would have to guess.
inline double parseEightAtOnce(std::string_view text) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (std::endian::native != std::endian::little || text.empty()) return kNone;
  const bool minus = text[0] == '-';
  const char* const first = text.data() + (minus ? 1 : 0);
  const std::size_t size = text.size() - (minus ? 1 : 0);
  const std::uint64_t whole = eightFrom(first);
  const std::size_t digits = leadingDigits(whole, size);
  if (digits < 1 || digits > 7) return kNone;
  const std::int64_t before_point = valueOf(whole << 8 * (8 - digits));
  if (digits == size) return decimalNumber(minus, before_point, 0);
  if (digits + 2 > size || size > digits + 9 || first[digits] != '.') return kNone;
  const std::size_t decimals = size - digits - 1;
  const std::uint64_t fraction = eightFrom(first + digits + 1) << 8 * (8 - decimals);
  if (notDigits(fraction) != 0) return kNone;
  return decimalNumber(minus, before_point * kShifts[decimals] + valueOf(fraction), decimals);
}

/// The value of a text of 1 to 7 digits; -1 for every other. As there, eight bytes behind it must be there to be read.
inline int wholeEightAtOnce(std::string_view text) {
  if (std::endian::native != std::endian::little || text.empty()) return -1;
  const std::uint64_t whole = eightFrom(text.data());
  const std::size_t digits = leadingDigits(whole, text.size());
  if (digits > 7 || digits != text.size()) return -1;
  return static_cast<int>(valueOf(whole << 8 * (8 - digits)));
}

/// A number as written, or why it is none.
struct ParsedNumber {
  double value = 0.0;
  std::string expectation;  ///< empty: `value` holds; else what was expected, for an InputError
};

/// Reads the whole of `text` as one finite decimal number, whatever the locale; a leading '+' is tolerated,
/// blanks around it are not (callers trim). Names a decimal comma and an unexpanded xacro expression for
/// what they are.
ParsedNumber parseNumber(std::string_view text);

/// The value of a text that is nothing but a sign, digits and a point, up to fifteen digits: the same value as
/// parseNumber's, sooner (decimalNumber). NaN for every other text, numbers among them.
double parsePlainNumber(std::string_view text);

/// Reads the whole of `text` as one integer; nullopt where it is none or too large. A leading '+' is
/// tolerated.
std::optional<int> parseInteger(std::string_view text);

}  // namespace stiffscope::io
