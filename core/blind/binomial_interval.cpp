#include "core/blind/binomial_interval.h"

#include <cmath>
#include <stdexcept>

namespace stiffscope::blind {

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

}  // namespace stiffscope::blind
