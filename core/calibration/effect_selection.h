#pragma once

#include <functional>
#include <vector>

#include "core/calibration/arm_fit.h"
#include "core/calibration/effect_terms.h"

namespace stiffscope::calibration {

struct SelectionOptions {
  /// Largest probability that noise alone makes a part look as large as it does, over all that were tried.
  double chance = 1e-3;
  /// Smallest share of the residual's sum of squares, on postures held out, that a part has to take away. With ten
  /// thousand postures chance forbids nothing any more, and what is below this share of what is left moves the arm by a
  /// fraction of the noise.
  double least_gain = 0.003;
  int most_parts = 40;
  std::size_t most_postures = 2000;  ///< evenly chosen: what is found grows with the root of their number, time with it
  int inner_folds = 5;
  /// To which of the inner folds a posture belongs, from its place in the campaign: pairs and branches stay together.
  std::function<int(int pose)> inner_fold;
};

/// Effects that the residuals of `geometry` ask for, in the order in which they were found. Greedy on the equations
/// linearised about the fit: of all parts (fixed ones; periodic errors of each joint with orders from 0.5 to 100 by
/// quarters, Lomb and Scargle's periodogram with the geometry projected off; jumps of frame and reflectors at every
/// posture) the one that explains most beyond what as many free parameters would by noise. It is taken where chance
/// forbids it not and where it predicts postures that were left out, geometry fitted with it.
/// Readings of weight 0 in the fit take no part.
std::vector<EffectPart> selectEffects(const UnloadedDay& day, const ArmFit& geometry, const SelectionOptions& options);

}  // namespace stiffscope::calibration
