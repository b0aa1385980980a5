#pragma once

#include <cstdint>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/fit.h"
#include "core/diagnosis/geometry_error.h"

namespace stiffscope::diagnosis {

/// What the verdict is made from.
struct VerdictInput {
  const SystemInput& input;
  const GapFit& fit;
  const std::vector<bool>& allowed;
  const preparation::DriftModel& station;
  const GeometryError& geometry;
  const preparation::NoiseModel& noise;
  const Gap& gap;
  const Gap& positions;
  bool as_measured = false;  ///< `gap` before is of readings with the station's motion, the fit's is not
};

/// A chosen model (by its place in the set) with the effects that cannot be told from it.
struct Tie {
  std::size_t chosen = 0;
  std::vector<effects::Effect> effects;
};

/// The verdict, the ranked classes, and the models by which each class's shrink is to be judged.
struct Decision {
  Verdict verdict;
  std::vector<EffectClass> classes;
  std::vector<std::vector<ChosenModel>> recipes;  ///< one a class
  std::vector<Tie> ties;
};

/// Names what the fit chose, each with the effects that this data cannot tell from it; the geometry against
/// the nominal one; `unknown` where what is left is significant and matters; nothing where neither. Beside `unknown` an
/// effect is named only where it removes nearly all of the gap that shows it: else it is a candidate, a class that is
/// not in the verdict. So is one that the nests, or repeats under a standing load, speak against.
Decision decideVerdict(const VerdictInput& from);

/// The fall of the score that the best of all effects reaches by chance, exceeded in a share `false_alarm` of
/// clean campaigns: the whole search is run on draws of pure noise. In whitened equations the right sides s
/// of noise have covariance S (see Projection), so a draw is S^1/2 times normal numbers.
double chanceLimit(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed, int draws,
                   double false_alarm, std::uint64_t seed);

/// The rms per coordinate that lowers chi2 of the loading by `drop`, m.
double sizeOfDrop(const GapFit& fit, double drop);

/// Per effect the smallest size that would have been named, m: what the median of its parts must be before
/// the projection for what is left of it to pass the limits of significance and of size, with all that the fit counts
/// as noise (the error of the model, the inflation of positions) in it. The geometry's is a limit of its own.
std::vector<DetectableSize> detectableSizes(const SystemInput& input, const GapFit& fit,
                                            const std::vector<bool>& allowed);

}  // namespace stiffscope::diagnosis
