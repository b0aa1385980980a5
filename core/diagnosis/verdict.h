#pragma once

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/diagnosis_input.h"
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

}  // namespace stiffscope::diagnosis
