#pragma once

#include <cstdint>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/fit.h"

namespace stiffscope::diagnosis {

/// Squares of what is left in the postures that a fit did not see.
struct HeldOut {
  double deflection_before = 0.0, deflection_after = 0.0;
  double position_before = 0.0, position_after = 0.0;
};

/// A way to fit: everything chosen anew, or one set of models with its parameters fitted anew.
struct FitRecipe {
  bool choose = false;              ///< run the whole selection
  std::vector<ChosenModel> models;  ///< else these
};

struct HeldOutShrink {
  Shrink deflection, position;
  double explained = 0.0;  ///< 1 - (after^2 - noise^2) / (before^2 - noise^2) of the deflection, in held-out postures
};

/// Leave-one-posture-out for the values. The interval: bootstrap samples of postures, each fitted (and, where
/// the recipe says so, selected) on the postures drawn and judged on those not drawn, so that no posture
/// stands on both sides; their spread is brought from the number of postures judged to that of all of them. Not a
/// number with fewer than four postures. `alone`: withoutEffects.
std::vector<HeldOutShrink> heldOutShrinks(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                                          const std::vector<bool>& allowed, const std::vector<FitRecipe>& recipes,
                                          int resamples, std::uint64_t seed);

/// Parameters (allParameters) of what is chosen and fitted on the other postures, one a posture of `fit`.
std::vector<Eigen::VectorXd> parametersWithoutEach(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                                                   const std::vector<bool>& allowed);

/// The same shrink from squares of postures held out that are there already, the interval by bootstrap samples of
/// these.
HeldOutShrink shrinkOver(const std::vector<HeldOut>& postures, int resamples, std::uint64_t seed);

/// Squares of deflection and position rows that parameters leave in a posture: of its equations without
/// effects, and of those with them.
HeldOut leftIn(const GapPosture& alone, const StiffnessesAlone& before, const GapPosture& posture,
               const Eigen::VectorXd& after);

/// Expected squares of the deflection rows by noise alone.
double noiseSquares(const GapPosture& posture);

}  // namespace stiffscope::diagnosis
