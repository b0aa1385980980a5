#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stiffscope {

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

}  // namespace stiffscope
