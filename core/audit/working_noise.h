#pragma once

#include <optional>

#include "core/audit/repeat_scatter.h"
#include "metrology/tracker_noise.h"

namespace stiffscope {

/// The tracker's noise as campaign.xml declares it; empty without a tracker, or where a figure is zero: a
/// variance of zero weights nothing.
std::optional<TrackerNoise> declaredNoise(const Campaign& campaign);

/// By how much the repeats scatter beyond the declared noise where that is more than chance explains
/// (chi-square at the audit's level), at the upper end of what they leave open; else 1.
struct NoiseFactors {
  double along = 1.0, across = 1.0;
};

NoiseFactors noiseFactors(const RepeatScatter& scatter);

/// The tracker with its noise along and across the beam multiplied. The repeats' check names a tracker that
/// is noisier than declared; the other checks then hold the readings against what the repeats show, so that
/// one cause gives one finding (GUM 4.2: an evaluation from repeats outweighs a data sheet).
Tracker asNoisyAs(Tracker tracker, const NoiseFactors& factors);

}  // namespace stiffscope
