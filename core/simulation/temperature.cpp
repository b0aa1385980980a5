#include "core/simulation/spec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stiffscope::simulation {

double TemperatureCourse::at(double time_s) const {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return celsius.front();
  if (after == times_s.end()) return celsius.back();
  const auto k = static_cast<std::size_t>(after - times_s.begin());
  const double share = (time_s - times_s[k - 1]) / (times_s[k] - times_s[k - 1]);
  return (1.0 - share) * celsius[k - 1] + share * celsius[k];
}

double TemperatureCourse::lagged(double time_s, double lag_s) const {
  if (lag_s <= 0.0 || time_s <= 0.0) return at(time_s);
  double follows = at(0.0), from = 0.0;
  // On a line T = T0 + v t from the place L0: L = T0 + v t - v lag + (L0 - T0 + v lag) exp(-t / lag).
  const auto along = [&](double until) {
    const double lasts = until - from, begin = at(from), slope = (at(until) - begin) / lasts;
    follows = begin + slope * (lasts - lag_s) + (follows - begin + slope * lag_s) * std::exp(-lasts / lag_s);
    from = until;
  };
  for (const double knot : times_s) {
    if (knot > from && knot < time_s) along(knot);
  }
  if (time_s > from) along(time_s);
  return follows;
}

}  // namespace stiffscope::simulation
