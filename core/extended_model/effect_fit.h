#pragma once

#include <vector>

#include "core/extended_model/fitted_effects.h"
#include "core/extended_model/requested_effects.h"

namespace stiffscope::extended_model {

/// `campaign`: as identification sees it; nests that have said what they know taken out of it. Throws InputError where
/// an effect cannot be tested with what the campaign has, naming what is missing, or where it cannot be told from
/// stiffnesses and geometry in these postures. No effect to fit: `added` is empty.
EffectFit fitEffects(const campaign::Campaign& campaign, const RequestedEffects& wanted);

/// The effects of the machine with their sizes at `parameters`, without those that are zero: what an ElasticArm bears.
std::vector<effects::PresentEffect> machineEffects(const EffectFit& effects, const Eigen::VectorXd& parameters);

/// The same parameters from a sample of the postures, each with its weight: one linear step from where the fit stands.
Eigen::VectorXd parametersFrom(const EffectFit& effects, const std::vector<double>& weights);

}  // namespace stiffscope::extended_model
