#include "core/diagnosis/effect_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/diagnosis/diagnose.h"

namespace stiffscope::diagnosis {

namespace {

double beyondNoise(const Gap& gap) {
  return gap.noise > 0.0 ? std::sqrt(std::max(0.0, gap.after * gap.after / (gap.noise * gap.noise) - 1.0)) : 0.0;
}

}  // namespace

double distanceFromVocabulary(const campaign::Campaign& campaign) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(campaign);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    if (!effects::concerns(static_cast<effects::Effect>(e), campaign.robot.rail.has_value())) continue;
    DiagnoseOptions options;
    options.resamples = options.chance_draws = 0;
    options.only = static_cast<effects::Effect>(e);
    const Diagnosis with_it = diagnose(prepared, options);
    if (!with_it.usable) return 0.0;
    least = std::min(least, std::max(beyondNoise(with_it.gap), beyondNoise(with_it.positions)));
  }
  return least;
}

}  // namespace stiffscope::diagnosis
