#pragma once

#include "core/diagnosis/selection.h"

namespace stiffscope {

/// Puts the estimates of a set (nuisances: compliances, geometry steps, weights) into what the next
/// linearisation starts from: the arm's compliances and geometry, the wrench, the frame, the unloaded place,
/// the shapes of effects that bend with their own size. Returns those effects that the equations made there
/// then contain.
ContainedEffects correct(const GapInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, GapState& state);

/// Whether the effect, once estimated, is part of what the equations are made with: of the unloaded arm's places at least.
bool becomesPart(const EffectModel& model);

/// Whether its parameters multiply other unknowns: a wrong wrench or a compensator's torque the compliances, a frame the
/// geometry.
bool isBilinear(const EffectModel& model);

}  // namespace stiffscope
