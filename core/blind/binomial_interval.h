#pragma once

namespace stiffscope::blind {

/// A share seen in trials, with its exact interval.
struct Rate {
  int hits = 0, trials = 0;
  double low = 0.0, high = 1.0;

  double value() const { return trials > 0 ? static_cast<double>(hits) / trials : 0.0; }
};

/// The interval of C. J. Clopper and E. S. Pearson (Biometrika 26, 1934): the shares p at which neither
/// P(X >= hits) nor P(X <= hits) is below (1 - level) / 2, X binomial; by bisection to 1e-12. Without trials
/// (0, 1). Throws std::invalid_argument where hits are not from 0 to trials.
Rate binomialRate(int hits, int trials, double level = 0.95);

}  // namespace stiffscope::blind
