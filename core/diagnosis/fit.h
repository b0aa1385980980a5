#pragma once

#include <memory>
#include <optional>

#include "core/diagnosis/linear_system.h"
#include "core/diagnosis/selection.h"

namespace stiffscope::diagnosis {

/// Variance factors of the absolute positions (`state.position_inflation`, `sweep_inflation`), from what the largest
/// model, all effects at once within their bounds, leaves of them. Never below 1.
void estimateInflation(const SystemInput& input, const LinearSystem& data, SystemState& state);

/// What a fit leaves of the loading's equations, in parts of their noise. Sweeps and what is known beforehand are
/// fitted together with them: of the parameters the loading pays for the share that it determines itself.
struct LoadingResidual {
  double chi2 = 0.0;
  double freedom = 1.0;  ///< equations less that share, tr N_L N^-1 with N_L of all normal equations N; one at least

  double perEquation() const { return chi2 / freedom; }
};

/// The gap with its effects, linearised where the best set of them stands.
struct GapFit {
  SystemState state;
  std::shared_ptr<const LinearSystem> data = std::make_shared<const LinearSystem>();  ///< tens of megabytes; never null
  Projection projection;
  SelectionRules rules;
  FittedSet set;
  Eigen::VectorXd nuisances;         ///< compliances, geometry steps, weights, with the set in the model
  Eigen::VectorXd nuisances_before;  ///< without any effect
  double model_error =
      0.0;  ///< rms per coordinate that the set leaves at the largest load beyond noise, m; 0: within it
  LoadingResidual left, left_before;  ///< with the set in the model; without any effect
  double left_limit = 0.0;  ///< of chi2 per equation (leftPerEquation): beyond it four standard deviations of chance
  int rounds = 0;
  /// Of the places where the fit began and where it ended, for those who make equations there again; may be null.
  std::shared_ptr<GeometryColumns> by_geometry;
};

struct FitRules {
  double noise_share = 0.5;  ///< of the noise of one state's displacement: an effect below it is too small to matter
  double deflection_share = 0.002;      ///< of the deflection: the same; the larger of the two is the limit
  double noise_degrees = 0.0;           ///< of freedom of the noise's own estimate; 0: taken as declared
  std::vector<std::size_t> given = {};  ///< models that other evidence puts in
  bool error_of_model = true;           ///< take what no effect explains as an error of the model, see fitGap
  /// Where it is there nothing is chosen: these models with these parts are fitted, whatever they bring.
  std::optional<std::vector<ChosenModel>> fixed = std::nullopt;
};

/// Linearises, selects, corrects and linearises again until the set stays: wrong load points, frames,
/// friction and a compensator multiply what else is estimated, so one linear step does not do.
///
/// Where a gap stays that no effect explains, it is taken as an error of the model that grows with the load,
/// one a posture and reflector, and everything is fitted and selected again with that error in the
/// covariance: an effect must then stand out of it, posture by posture.
GapFit fitGap(const SystemInput& input, const SystemState& start, const std::vector<bool>& allowed,
              const FitRules& rules);

/// The gap that joint stiffnesses alone leave: wrenches and places as declared in `start`, no effect in the
/// equations; where `fit` stands its bilinear effects have corrected both, so that a zero parameter there is
/// not a machine without the effect. Weighted as `fit` is.
GapFit withoutEffects(const SystemInput& input, const SystemState& start, const GapFit& fit);

/// chi2 of the loading per degree of freedom that the set leaves: 1 where it is noise.
inline double leftPerEquation(const GapFit& fit) { return fit.left.perEquation(); }

/// By what variances are widened where more than noise is left: chi2 per equation of the loading, at least 1, with the
/// sweeps' deviation from theirs in it and no parameters taken off, as the selection has it (Selector::misfit).
double varianceFactor(const GapFit& fit);

/// What chi2 over its degrees of freedom may be by chance: four standard deviations, with the doubt of a noise that was
/// itself estimated with so many degrees of freedom; beyond 1.6 where it is as declared (0), which is right to a
/// quarter.
double limitOfChiSquare(double freedom, double noise_degrees);

/// Whether deflections stay that no effect explains: beyond chance (left_limit), and large enough to matter. A verdict
/// then says `unknown`, and identification that its values are apparent ones.
inline bool leavesUnexplained(const GapFit& fit) { return fit.model_error > 0.0; }

/// Variances of the compliances with the set in the model, by the noise alone.
JointVector complianceVariance(const GapFit& fit, const SystemInput& input);

Selector selectorOf(const SystemInput& input, const GapFit& fit, const Projection& projection, double postures,
                    const std::vector<bool>& allowed);

/// Puts the estimates of a set (nuisances: compliances, geometry steps, weights) into what the next
/// linearisation starts from: the arm's compliances and geometry, the wrench, the frame, the unloaded place,
/// the shapes of effects that bend with their own size. Returns those effects that the equations made there
/// then contain.
ContainedEffects correct(const SystemInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, SystemState& state);

/// Effects that bend with their own size and were not chosen would be judged at whatever shape they began with. Brings
/// each in `at` to the shape of the best set that has it beside the chosen ones or in the place of one of them, and
/// where it is not worth it in any, to none. `selector`: of the equations that `fit` stands on.
void settleRivals(const SystemInput& input, const GapFit& fit, const Selector& selector,
                  const std::vector<bool>& allowed, effects::LinearizationPoint& at);

/// Whether the effect, once estimated, is part of what the equations are made with: of the unloaded arm's places at
/// least.
bool becomesPart(const effects::EffectModel& model);

/// Whether its parameters multiply other unknowns: a wrong wrench or a compensator's torque the compliances, a frame
/// the geometry.
bool isBilinear(const effects::EffectModel& model);

/// Where equations of the gap are made, and what they contain there.
struct JointlyFitted {
  SystemState state;
  ContainedEffects contained;
};

/// Nonlinear least squares (Ceres, trust region) over the set's parameters and all nuisances together, for
/// sets with an effect whose parameters multiply other unknowns (a wrong load point times a compliance).
/// Minimises chi2(x) = |L^-1 (y(x) - A(x) x)|^2 plus the effects' priors, from `set` and `nuisances` as found
/// where `from` stands. The equations A, y are made afresh at every trial x (linearSystem), so that a step counts
/// only where it really lowers chi2; their columns are the Jacobian. Empty where no effect of the set is
/// bilinear, where friction or play is in it, or where nothing better was found.
std::optional<JointlyFitted> fitJointly(const SystemInput& input, const SystemState& from, const GapLayout& layout,
                                        const FittedSet& set, const Eigen::VectorXd& nuisances,
                                        GeometryColumns& by_geometry);

}  // namespace stiffscope::diagnosis
