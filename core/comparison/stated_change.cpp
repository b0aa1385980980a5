#include "core/comparison/stated_change.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

namespace {

constexpr double kNormalDegrees = 1e6;  // quantiles of draws are no Student's t

/// The changes of pairs that both are there; `difference` of two gives the change.
template <class Number, class Difference>
std::vector<std::optional<StatedChange>> changesOf(const std::vector<std::optional<Number>>& before,
                                                   const std::vector<std::optional<Number>>& after,
                                                   const Difference& difference) {
  std::vector<std::optional<StatedChange>> changes(std::min(before.size(), after.size()));
  std::vector<double> p_values(changes.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!before[i] || !after[i]) continue;
    StatedChange& change = changes[i].emplace();
    change.difference = difference(*before[i], *after[i]);
    p_values[i] = change.p_value = pOfZero(change.difference, std::abs(before[i]->value));
  }
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (changes[i]) changes[i]->p_holm = corrected[i];
  }
  return changes;
}

}  // namespace

double pOfZero(const Uncertain& number, double size) {
  constexpr double kRounding = 1e-12;  // of the size: what is left of equal ones
  if (!std::isfinite(number.sd) || !(number.dof > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  if (number.sd <= kRounding * size)
    return std::abs(number.value) <= kRounding * size ? 1.0 : std::numeric_limits<double>::quiet_NaN();
  const double t = number.value / number.sd;
  return metrology::fTail(t * t, 1, number.dof);
}

double fartherEnd(double value, const identification::CoverageInterval& interval) {
  return std::max(interval.high - value, value - interval.low);
}

Uncertain differenceOfStated(double before, const identification::CoverageInterval& interval_before, double after,
                             const identification::CoverageInterval& interval_after) {
  const double expanded = std::hypot(fartherEnd(before, interval_before), fartherEnd(after, interval_after));
  return {after - before, expanded / identification::kNormalFactor, kNormalDegrees, expanded};
}

std::vector<std::optional<StatedChange>> statedChanges(const std::vector<std::optional<StatedCompliance>>& before,
                                                       const std::vector<std::optional<StatedCompliance>>& after) {
  return changesOf(before, after, [](const StatedCompliance& a, const StatedCompliance& b) {
    return differenceOfStated(a.value, a.interval, b.value, b.interval);
  });
}

std::vector<std::optional<StatedChange>> statedChanges(const std::vector<std::optional<Uncertain>>& before,
                                                       const std::vector<std::optional<Uncertain>>& after) {
  return changesOf(before, after, [](const Uncertain& a, const Uncertain& b) {
    return Uncertain{b.value - a.value, std::hypot(a.sd, b.sd), kNormalDegrees};
  });
}

}  // namespace stiffscope::comparison
