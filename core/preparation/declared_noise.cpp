#include "core/preparation/declared_noise.h"

#include <cmath>
#include <cstddef>

#include "core/frames/joint_axes.h"

namespace stiffscope::preparation {

std::optional<metrology::TrackerNoise> declaredNoise(const campaign::Campaign& campaign) {
  if (!campaign.tracker) return std::nullopt;
  const campaign::Tracker& tracker = *campaign.tracker;
  if (tracker.range_fixed + tracker.range_per_m <= 0.0 || tracker.angle_fixed + tracker.angle_per_m <= 0.0)
    return std::nullopt;
  return frames::trackerNoise(tracker);
}

namespace {

template <class Row>
Rounded roundedIn(const std::vector<Row>& rows, const metrology::TrackerNoise& noise) {
  // Round figures of fewer rows may be chance; a tenth of a micrometre is below any tracker's noise.
  constexpr std::size_t kFewest = 4;
  constexpr double kFelt = 1e-6;  // m
  Rounded rounded;
  if (rows.size() < kFewest) return rounded;
  const double digit = lastDigit(rows, kFelt);
  if (digit == 0.0) return rounded;
  const double variance = digit * digit / 12.0, share = 1.0 / static_cast<double>(rows.size());
  double along = 0.0, across = 0.0;  // of the noise's variance, mean of all readings
  for (const Row& row : rows) {
    const double distance = (row.point - noise.seenFrom(row.from).station).norm();
    along += share * variance / std::pow(noise.range_fixed + noise.range_per_m * distance, 2);
    across += share * variance / std::pow(noise.angle_fixed + noise.angle_per_m * distance, 2);
  }
  rounded.digit = digit;
  rounded.factors = {std::sqrt(1.0 + along), std::sqrt(1.0 + across)};
  return rounded;
}

}  // namespace

campaign::Tracker asNoisyAs(campaign::Tracker tracker, const NoiseFactors& factors) {
  tracker.range_fixed *= factors.along;
  tracker.range_per_m *= factors.along;
  tracker.angle_fixed *= factors.across;
  tracker.angle_per_m *= factors.across;
  return tracker;
}

Rounding roundingOf(const campaign::Campaign& campaign) {
  Rounding rounding;
  const std::optional<metrology::TrackerNoise> noise = declaredNoise(campaign);
  if (!noise) return rounding;
  const auto coarsest = [&](const auto& table) {
    if (!table) return;
    const Rounded own = roundedIn(table->rows, *noise);
    if (own.digit > rounding.arm.digit) rounding.arm = own;
  };
  coarsest(campaign.loading);  // of tables with as many digits that with the repeats
  coarsest(campaign.circle_sweeps);
  coarsest(campaign.wrist_sweep);
  coarsest(campaign.rail_sweep);
  if (campaign.nests) rounding.nests = roundedIn(campaign.nests->rows, *noise);
  return rounding;
}

}  // namespace stiffscope::preparation
