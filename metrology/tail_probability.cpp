#include "metrology/tail_probability.h"

#include <cmath>
#include <limits>

namespace stiffscope::metrology {

namespace {

/// The continued fraction of the incomplete beta function by Lentz' method; converges fast for x <
/// (a+1)/(a+b+2).
double betaFraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto apart = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1.0, d = 1.0 / apart(1.0 - (a + b) * x / (a + 1.0)), fraction = d;
  constexpr int kMostTerms = 10000;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    d = 1.0 / apart(1.0 + even * d), c = apart(1.0 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    d = 1.0 / apart(1.0 + odd * d), c = apart(1.0 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < 4.0 * std::numeric_limits<double>::epsilon()) break;
  }
  return fraction;
}

/// Regularised incomplete beta function I_x(a, b); `y` is 1 - x, given apart because x may be near 1.
double incompleteBeta(double a, double b, double x, double y) {
  if (x <= 0.0) return 0.0;
  if (y <= 0.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * betaFraction(a, b, x) / a;
  return 1.0 - front * betaFraction(b, a, y) / b;
}

}  // namespace

double chiSquareTail(double value, int degrees) {
  return degrees == 1 ? std::erfc(std::sqrt(0.5 * value)) : std::exp(-0.5 * value);
}

double fTail(double value, int above, double below) {
  const double odds = above * value / below;
  return incompleteBeta(0.5 * below, 0.5 * above, 1.0 / (1.0 + odds), odds / (1.0 + odds));
}

}  // namespace stiffscope::metrology
