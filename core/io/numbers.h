#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stiffscope::io {

/// A number as written, or why it is none.
struct ParsedNumber {
  double value = 0.0;
  std::string expectation;  ///< empty: `value` holds; else what was expected, for an InputError
};

/// Reads the whole of `text` as one finite decimal number, whatever the locale; a leading '+' is tolerated,
/// blanks around it are not (callers trim). Names a decimal comma and an unexpanded xacro expression for
/// what they are.
ParsedNumber parseNumber(std::string_view text);

/// The value where the whole of `text` is one finite decimal number without '+'; else NaN. For tables of millions of
/// cells, which ask parseNumber only about the cells that are none.
double numberOrNan(std::string_view text);

/// Reads the whole of `text` as one integer; nullopt where it is none or too large. A leading '+' is
/// tolerated.
std::optional<int> parseInteger(std::string_view text);

}  // namespace stiffscope::io
