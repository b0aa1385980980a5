#include "core/numerics/distributions.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace stiffscope::numerics {

namespace {

constexpr int kMostTerms = 100000;
constexpr double kPrecision = 1e-14;
constexpr double kTiny = 1e-300;  // keeps Lentz's continued fractions from dividing by zero

/// Upper regularised incomplete gamma function Q(a, x): series below a + 1, continued fraction above.
double upperGamma(double a, double x) {
  if (x <= 0.0) return 1.0;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < kMostTerms && term > kPrecision * sum; ++n) sum += term *= x / (a + n);
    return 1.0 - scale * sum;
  }
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, h = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b + kTiny);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1.0) < kPrecision) break;
  }
  return scale * h;
}

/// P(|t| > limit): the incomplete beta function of u = dof/(dof + limit^2), (dof/2, 1/2), by Simpson's rule
/// over v = sqrt(u), in which the integrand is smooth at 0.
double studentTail(double limit, double dof) {
  const double scale =
      2.0 * std::exp(std::lgamma(0.5 * (dof + 1.0)) - std::lgamma(0.5 * dof)) / std::sqrt(std::numbers::pi);
  const double end = std::sqrt(dof / (dof + limit * limit));
  const auto density = [&](double v) { return std::pow(v, dof - 1.0) / std::sqrt(1.0 - v * v); };
  constexpr int kSteps = 2000;
  double sum = density(0.0) + density(end);
  for (int n = 1; n < kSteps; ++n) sum += (n % 2 == 1 ? 4.0 : 2.0) * density(end * n / kSteps);
  return scale * sum * end / (3.0 * kSteps);
}

/// Where a falling function of a positive variable crosses `tail`.
template <class Tail>
double crossing(double tail, const Tail& tail_beyond) {
  double low = 0.0, high = 1.0;
  while (tail_beyond(high) > tail && high < 1e12) low = high, high *= 2.0;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (tail_beyond(middle) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double chiSquareLimit(double tail, double dof) {
  return crossing(tail, [&](double x) { return upperGamma(0.5 * dof, 0.5 * x); });
}

double normalLimit(double tail) { return std::sqrt(chiSquareLimit(tail, 1.0)); }

double studentLimit(double tail, double dof) {
  return crossing(tail, [&](double t) { return studentTail(t, dof); });
}

namespace {

/// P(X <= most), X binomial.
double atMost(int most, int trials, double share) {
  if (share <= 0.0) return 1.0;
  if (share >= 1.0) return most >= trials ? 1.0 : 0.0;
  double sum = 0.0;
  for (int k = 0; k <= most; ++k) {
    sum += std::exp(std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0) +
                    k * std::log(share) + (trials - k) * std::log1p(-share));
  }
  return sum;
}

/// The share at which P(X <= most), which falls as it grows, is `probability`.
double shareWhere(int most, int trials, double probability) {
  double low = 0.0, high = 1.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (atMost(most, trials, middle) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Rate binomialRate(int hits, int trials, double level) {
  if (hits < 0 || hits > trials) throw std::invalid_argument("hits are not from 0 to trials");
  Rate rate{hits, trials, 0.0, 1.0};
  const double tail = 0.5 * (1.0 - level);
  if (hits > 0) rate.low = shareWhere(hits - 1, trials, 1.0 - tail);
  if (hits < trials) rate.high = shareWhere(hits, trials, tail);
  return rate;
}

}  // namespace stiffscope::numerics
