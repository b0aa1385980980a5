#include "core/audit/working_noise.h"

#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/finding.h"
#include "core/frames/measured_axes.h"

namespace stiffscope {

namespace {

double factorOf(double chi2, int dof) {
  if (dof < 1 || chi2 <= chiSquareLimit(kLevel, dof)) return 1.0;
  // The upper end of its 95 % interval: another check of as many readings would else find the rest of the
  // scatter that this estimate happens to miss. A standard deviation's own is 1/sqrt(2 dof) of it.
  constexpr double kSigmas = 2.0;
  return std::sqrt(chi2 / dof) * (1.0 + kSigmas / std::sqrt(2.0 * dof));
}

}  // namespace

std::optional<TrackerNoise> declaredNoise(const Campaign& campaign) {
  if (!campaign.tracker) return std::nullopt;
  const Tracker& tracker = *campaign.tracker;
  if (tracker.range_fixed + tracker.range_per_m <= 0.0 || tracker.angle_fixed + tracker.angle_per_m <= 0.0)
    return std::nullopt;
  return trackerNoise(tracker);
}

NoiseFactors noiseFactors(const RepeatScatter& scatter) {
  return {factorOf(scatter.along_chi2, scatter.along_dof), factorOf(scatter.across_chi2, scatter.across_dof)};
}

Tracker asNoisyAs(Tracker tracker, const NoiseFactors& factors) {
  tracker.range_fixed *= factors.along;
  tracker.range_per_m *= factors.along;
  tracker.angle_fixed *= factors.across;
  tracker.angle_per_m *= factors.across;
  return tracker;
}

}  // namespace stiffscope
