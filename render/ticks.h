#pragma once

#include <string>
#include <vector>

namespace stiffscope::render {

/// The largest number of the series 1, 2, 5, 10, ... not above `x` > 0, and the smallest not below.
double roundDown125(double x);
double roundUp125(double x);

/// Positions of ticks and how they read.
struct Ticks {
  std::vector<double> positions;
  std::vector<std::string> labels;
};

/// Multiples of a step of the series 1-2-5 inside [lower, upper], at most `most` of them, and at least two whatever
/// that is: one alone tells no scale. Requires lower < upper, both finite.
Ticks linearTicks(double lower, double upper, int most);

/// Powers of ten, and 2 and 5 times those where the range is short, inside [lower, upper]. Requires 0 < lower
/// < upper.
Ticks logTicks(double lower, double upper);

/// `x` in at most four significant digits, without trailing zeros: for numbers beside marks.
std::string shortNumber(double x);

/// A factor as people write it: "40 000" (no-break spaces) where shortNumber has powers of ten, up to a million.
std::string factorText(double x);

}  // namespace stiffscope::render
