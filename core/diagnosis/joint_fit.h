#pragma once

#include <optional>

#include "core/diagnosis/linear_system.h"
#include "core/diagnosis/selection.h"

namespace stiffscope::diagnosis {

/// Puts the estimates of a set (nuisances: compliances, geometry steps, weights) into what the next
/// linearisation starts from: the arm's compliances and geometry, the wrench, the frame, the unloaded place,
/// the shapes of effects that bend with their own size. Returns those effects that the equations made there
/// then contain.
ContainedEffects correct(const SystemInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, SystemState& state);

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
                                        const FittedSet& set, const Eigen::VectorXd& nuisances);

}  // namespace stiffscope::diagnosis
