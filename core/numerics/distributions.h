#pragma once

#include <cstddef>

namespace stiffscope::numerics {

// Critical values, by Boost.Math. Without degrees of freedom, and where `tail` is 1 or more, they are zero.

/// The value that a chi-square variable with `dof` degrees of freedom exceeds with probability `tail`.
double chiSquareLimit(double tail, double dof);

/// The value that the magnitude of a standard normal variable exceeds with probability `tail`.
double normalLimit(double tail);

/// The value that the magnitude of Student's t with `dof` degrees of freedom exceeds with probability `tail`.
double studentLimit(double tail, double dof);

/// The largest deviate that `chiSquareDeviate` gives: chance exceeds it in 1e-16 of all cases.
inline constexpr double kLargestDeviate = 8.222;

/// A chi-square variable's value as standard normal deviates: chance exceeds both as often. dof > 0, not necessarily
/// whole. Within +- kLargestDeviate: beyond it neither the noise nor its distribution is known well enough.
double chiSquareDeviate(double value, double dof);

/// P(N >= count), N of Poisson's distribution with that mean; mean 0 or more.
double poissonTail(std::size_t count, double mean);

/// A share seen in trials, with its exact interval.
struct Rate {
  int hits = 0, trials = 0;
  double low = 0.0, high = 1.0;

  double value() const { return trials > 0 ? static_cast<double>(hits) / trials : 0.0; }
};

/// The interval of C. J. Clopper and E. S. Pearson (Biometrika 26, 1934): the shares p at which neither
/// P(X >= hits) nor P(X <= hits) is below (1 - level) / 2, X binomial. Without trials (0, 1). Throws
/// std::invalid_argument where hits are not from 0 to trials.
Rate binomialRate(int hits, int trials, double level = 0.95);

}  // namespace stiffscope::numerics
