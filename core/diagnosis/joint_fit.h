#pragma once

#include <optional>

#include "core/diagnosis/selection.h"

namespace stiffscope {

/// Where equations of the gap are made, and what they contain there.
struct JointlyFitted {
  GapState state;
  ContainedEffects contained;
};

/// Nonlinear least squares (Ceres, trust region) over the set's parameters and all nuisances together, for
/// sets with an effect whose parameters multiply other unknowns (a wrong load point times a compliance).
/// Minimises chi2(x) = |L^-1 (y(x) - A(x) x)|^2 plus the effects' priors, from `set` and `nuisances` as found
/// where `from` stands. The equations A, y are made afresh at every trial x (gapData), so that a step counts
/// only where it really lowers chi2; their columns are the Jacobian. Empty where no effect of the set is
/// bilinear, where friction or play is in it, or where nothing better was found.
std::optional<JointlyFitted> fitJointly(const GapInput& input, const GapState& from, const GapLayout& layout,
                                        const FittedSet& set, const Eigen::VectorXd& nuisances);

}  // namespace stiffscope
