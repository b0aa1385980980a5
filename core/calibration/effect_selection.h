#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/calibration/arm_fit.h"
#include "core/calibration/effect_terms.h"

namespace stiffscope::calibration {

struct SelectionOptions {
  /// Largest probability that noise alone makes any effect look as large as it does, over all that were tried.
  double chance = 1e-3;
  /// Smallest share of the residual's sum of squares, on postures held out, that an effect has to take away. With ten
  /// thousand postures chance forbids nothing any more, and what is below this share of what is left moves the arm by a
  /// fraction of the noise.
  double least_gain = 0.003;
  int search_parts = 6, most_parts = 40;  ///< of one effect, while the effects are sought and at the end
  /// Postures that tell which effects there are, and postures that tell how many parts each has: what is found grows
  /// with the root of their number, time with it.
  std::size_t search_postures = 400, most_postures = 2000;
  int inner_folds = 5;
  /// To which of the inner folds a posture belongs, from its place in the campaign: pairs and branches stay together.
  std::function<int(int pose)> inner_fold;
  int outer_folds = 2;  ///< those that held-out figures are stated for
  std::function<int(int pose)> outer_fold;
  int divisions = 0;  ///< beside the outer folds, see LinearisedDay::heldOutByDivision; 0: no sums by division
};

/// An effect that does nearly as well in the place of one that was selected.
struct Rival {
  UnloadedEffect effect = {};
  std::string detail;
  double cost = 0.0;  ///< by which BIC is higher with it
};

struct SelectedEffect {
  UnloadedEffect effect = {};
  /// Others of the set that explain the same: what each takes away beside the rest is a small part of what all do.
  /// Everything below is of all of them.
  std::vector<UnloadedEffect> together = {};
  std::string detail;               ///< of its parts, each once; empty where they name nothing
  double score = 0.0;               ///< fall of BIC against the others without it
  double size = 0.0;                ///< rms per coordinate of what it explains beside them, m
  std::vector<Rival> rivals;        ///< within kAsGood, best first
  std::vector<double> held_out;     ///< as SelectedEffects::before, with this effect alone beside the geometry
  std::vector<double> by_division;  ///< sums of that
};

/// BIC tells models apart that differ by this much: odds of 90 to 1.
inline constexpr double kAsGood = 9.0;

struct SelectedEffects {
  std::vector<EffectPart> parts;        ///< those of an effect stand together
  std::vector<SelectedEffect> effects;  ///< the one that explains most first
  /// Squared residuals of postures, m^2, each outer fold by what the others fit: of the geometry.
  std::vector<double> before;
  /// Sums of that by each division into folds, the outer folds first: of the geometry, and with all effects.
  std::vector<double> before_by_division, after_by_division;
  /// For each effect that the day can show, what it would have to explain to be named, in parts of what is then left.
  std::vector<std::pair<UnloadedEffect, double>> detectable;
};

/// With fewer postures no effect is asked for.
inline constexpr std::size_t kFewestForEffects = 20;

/// Effects that the residuals of `geometry` ask for. On the equations linearised about the fit, sets of effects are
/// compared by BIC (as many equations as reflectors of a posture that err together are worth; alternatives that were
/// tried count as parameters): from none, and from each of the best single ones, one is added, dropped, replaced by
/// another, or fitted anew beside the rest, as long as that is better. Periodic errors of enough orders can imitate any
/// function of a joint's angle, so each other effect is tried before them, too. An effect must be beyond chance and
/// predict postures that were left out, geometry fitted with it. Periodic errors are of each joint, with orders from
/// 0.5 to 100 by quarters (Lomb and Scargle's periodogram with the rest projected off); jumps may be at every posture.
/// Readings of weight 0 in the fit take no part.
SelectedEffects selectEffects(const UnloadedDay& day, const ArmFit& geometry, const SelectionOptions& options);

}  // namespace stiffscope::calibration
