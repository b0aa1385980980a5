#pragma once

#include <vector>

namespace stiffscope::simulation {

/// The temperature through a day: stated at times, straight lines between them, constant before the first and after the
/// last.
struct TemperatureCourse {
  std::vector<double> times_s;  ///< rising; at least one
  std::vector<double> celsius;  ///< as many

  double at(double time_s) const;

  /// What follows it with a lag of first order, in balance at time 0: L' = (T - L) / lag, L(0) = T(0). Exact for
  /// straight lines; without a lag T itself.
  double lagged(double time_s, double lag_s) const;
};

}  // namespace stiffscope::simulation
