#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/comparison/paired_fit.h"
#include "core/identification/estimate.h"

namespace stiffscope::comparison {

// Two results that only state values and intervals: files of other days, models of two days. What both miss does not
// cancel in their difference, as it does where readings on the same postures are there (PairedFit).

/// Two-sided probability of a value as far from zero, by its own sd and degrees of freedom; not a number where it has
/// no sd. Rounding of what is equal is told by `size`, that of the numbers whose difference it is.
double pOfZero(const Uncertain& number, double size);

/// How far the farther end of an interval is from its value: U of a value whose interval is not symmetric.
double fartherEnd(double value, const identification::CoverageInterval& interval);

/// after - before, as independent: U is the root of the sum of squares of both U (95 %).
Uncertain differenceOfStated(double before, const identification::CoverageInterval& interval_before, double after,
                             const identification::CoverageInterval& interval_after);

/// A compliance as a result states it, rad/Nm.
struct StatedCompliance {
  double value = 0.0;
  identification::CoverageInterval interval;  ///< 95 %
};

struct StatedChange {
  Uncertain difference;  ///< after - before
  double p_value = 0.0;  ///< of no difference
  double p_holm = 0.0;   ///< corrected for those compared (holm)

  bool significant() const { return p_holm < 0.05; }
};

/// Of what both state, in the order given; empty where either does not.
std::vector<std::optional<StatedChange>> statedChanges(const std::vector<std::optional<StatedCompliance>>& before,
                                                       const std::vector<std::optional<StatedCompliance>>& after);

/// The same of any numbers with standard uncertainties whose degrees of freedom are many (lengths, angles).
std::vector<std::optional<StatedChange>> statedChanges(const std::vector<std::optional<Uncertain>>& before,
                                                       const std::vector<std::optional<Uncertain>>& after);

}  // namespace stiffscope::comparison
