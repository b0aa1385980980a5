#pragma once

#include <fmt/format.h>
#include <string>
#include <vector>

#include "core/identification/estimate.h"

// Numbers as people read them: a real minus sign, no-break space before a unit, digits to the uncertainty.

namespace stiffscope::identification {
struct Identification;
struct Transmission;
}  // namespace stiffscope::identification

namespace stiffscope::diagnosis {
struct Diagnosis;
}

namespace stiffscope::reports {

inline constexpr double kMmPerM = 1e3;
inline constexpr double kMega = 1e6;

/// The unit in which a set of stiffnesses is printed, so that none begins with zeros: 10^6 Nm/rad of a large robot,
/// 10^3 of one whose wrist has less than 0.01 10^6, Nm/rad of one with less than ten.
struct StiffnessUnit {
  double size = kMega;  ///< Nm/rad
  const char* name = "10⁶\u00a0Nm/rad";
  const char* text = "1e6 Nm/rad";  ///< on a terminal
};
/// Of values in Nm/rad; those that are not finite or zero are left out. Without any 10^6.
StiffnessUnit stiffnessUnit(const std::vector<double>& stiffnesses);
StiffnessUnit stiffnessUnit(const identification::Identification& result);      ///< of what its methods identify
StiffnessUnit stiffnessUnit(const identification::Transmission& transmission);  ///< of the gears that are measured
StiffnessUnit stiffnessUnit(const diagnosis::Diagnosis& diagnosis);             ///< with the verdict's effects

/// The unit in which small lengths of a size are printed, so that none has five digits before its point.
struct LengthUnit {
  double size = 1e-6;  ///< m
  const char* name = "µm";
  const char* text = "um";  ///< on a terminal
};
/// Of the largest of them, m: what would print as 1000 µm or more is in mm.
LengthUnit lengthUnit(double largest);

/// "9.4 um" with `decimals` places; from a millimetre on "58.05 mm". In a text; withMicro for the page.
std::string lengthWords(double metres, int decimals);

/// "9.4 µm", "58 mm": as many significant digits, a no-break space before the unit. On the page.
std::string shownLength(double metres, int digits);

/// The fewest decimal places, up to two, with which two numbers that differ do not print alike.
int placesThatTell(double low, double high);

/// From standard to expanded uncertainty, U = k u (GUM, annex G): Student's t for 95 % at the effective degrees of
/// freedom of a joint's compliance. NaN where none is left.
struct Coverage {
  double factor = 0.0;
  double degrees_of_freedom = 0.0;
};
Coverage coverageOf(const identification::StiffnessEstimate& estimate, int joint);

/// U of a standard uncertainty whose degrees of freedom are many: 1.96 u, 95 % of a normal distribution. What people
/// read behind ± is a U, unless its heading names something else.
double expanded(double standard_uncertainty);

/// `decimals` places; "–" (no number) where the value is not finite.
std::string fixed(double value, int decimals);

/// `digits` significant digits without exponent below 10^7; above, with one.
std::string significant(double value, int digits);

/// "5.60 ± 0.10": the uncertainty (or spread) to two digits, the value to the same place. Without a finite positive
/// uncertainty the value to four digits.
std::string withUncertainty(double value, double uncertainty);

/// Whether any method has a joint's stiffness, or an end of its interval, above zero: a logarithmic axis has no place
/// for others.
bool anyPositiveStiffness(const identification::Identification& result);

/// Whether the stated interval of a joint's stiffness is far from symmetric, or open: from a fifth of the compliance on
/// its two ends are half as far again from the value as each other.
bool farFromSymmetric(const identification::StiffnessEstimate& estimate, int joint);

/// A stiffness with its uncertainty for a cell of a table, in parts of `unit` Nm/rad: "5.60 ± 0.10". Where a ± would
/// hold what the data exclude, the stated interval with two digits: "6.2 (4.1 to 17)", "0.52 (above 0.22)", and of a
/// negative fit that only says how stiff the joint is at least "above 5.0 (fit −4.2)". "0.52 (U open)" without one.
std::string uncertainStiffness(const identification::StiffnessEstimate& estimate, int joint, double unit);

/// `value` to the place of the second digit of `width`, a range or an uncertainty: numbers beside it have the
/// same digits. Without a finite positive width four significant digits.
std::string toPlaceOf(double value, double width);

/// Decimal places down to the second digit of an uncertainty, none where that stands before the point; `without` where
/// there is none.
int placesOf(double uncertainty, int without);

/// As few digits as tell the number: for one that comes from print.
std::string asPrinted(double value);

/// A share as "84.3 %". A share that is not the whole is not printed as the whole: with no decimals 0.997 is "99.7 %",
/// down to a hundredth of a percent.
std::string percent(double share, int decimals = 1);
std::string percentNumber(double share, int decimals);  ///< the same without its sign: "84.3"

/// A text of core with its units as people write them: um as µm, urad as µrad, +- as ±, chi2 as χ². Only
/// whole words are changed.
std::string withMicro(const std::string& text);

/// For a terminal: "um" and "urad" behind a number or an opening bracket as µm and µrad; the rest stays as wide as it
/// is, so that columns stay under each other.
std::string microUnits(const std::string& text);

/// For a terminal that shows UTF-8: "+-" as ±. Columns stay under each other: where ± is a letter narrower the gap
/// before its column is a blank wider.
std::string plusMinusSigns(const std::string& text);

/// `value` for printing with `decimals` places: what rounds to zero is zero, without the sign that would
/// print as -0.000.
inline double unsignedZero(double value, int decimals) {
  const std::string printed = fmt::format("{:.{}f}", value, decimals);
  return printed.find_first_of("123456789") == std::string::npos ? 0.0 : value;
}

/// Text broken at blanks to lines of at most 98 columns, those after the first indented by `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent);

/// "1.50 kN"; below a kilonewton "92.3 N", as a small robot lifts.
std::string forceWords(double newtons);

double um(double metres);  ///< in micrometres

}  // namespace stiffscope::reports
