#pragma once

#include <vector>

namespace stiffscope {

/// What a box shows of a distribution: its percentiles and its mean, in the distribution's unit.
struct Spread {
  double p5 = 0;
  double p25 = 0;
  double p50 = 0;
  double p75 = 0;
  double p95 = 0;
  double mean = 0;
};

/// Percentiles by linear interpolation between order statistics (x at rank p (n - 1)), and the arithmetic
/// mean. Throws std::invalid_argument when there is no sample or one is not finite.
Spread spreadOf(std::vector<double> samples);

}  // namespace stiffscope
