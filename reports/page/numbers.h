#pragma once

#include <string>

// Numbers as people read them: a real minus sign, no-break space before a unit, digits to the uncertainty.

namespace stiffscope::page {

/// `decimals` places; "–" (no number) where the value is not finite.
std::string fixed(double value, int decimals);

/// `digits` significant digits without exponent below 10^7; above, with one.
std::string significant(double value, int digits);

/// "5.60 ± 0.10": the standard uncertainty to two digits, the value to the same
/// place. Without a finite positive uncertainty the value to four digits.
std::string withUncertainty(double value, double standard_uncertainty);

/// `value` to the place of the second digit of `width`, a range or an uncertainty: numbers beside it have the
/// same digits. Without a finite positive width four significant digits.
std::string toPlaceOf(double value, double width);

/// As few digits as tell the number: for one that comes from print.
std::string asPrinted(double value);

/// A share as "84.3 %".
std::string percent(double share, int decimals = 1);

}  // namespace stiffscope::page
