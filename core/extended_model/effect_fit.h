#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/extended_model/fitted_effects.h"
#include "core/extended_model/requested_effects.h"
#include "core/preparation/prepare.h"

namespace stiffscope::extended_model {

/// An effect that was asked for and cannot be fitted to the campaign, and why.
class UnfitEffect : public std::runtime_error {
 public:
  UnfitEffect(effects::Effect effect, Remark reason)
      : std::runtime_error(std::string(effects::idOf(effect))), effect_(effect), reason_(std::move(reason)) {}

  effects::Effect effect() const { return effect_; }
  const Remark& reason() const { return reason_; }

 private:
  effects::Effect effect_;
  Remark reason_;
};

/// Throws UnfitEffect where an effect cannot be tested with what the campaign has, naming what is missing, or where it
/// cannot be told from stiffnesses and geometry in these postures. No effect to fit: `added` is empty. On a long day
/// (diagnosis::isLong) they are fitted to the postures that the diagnosis takes; `day` has all.
EffectFit fitEffects(const preparation::PreparedCampaign& prepared, const RequestedEffects& wanted);
/// Fits to a campaign as it was read, which is prepared first.
EffectFit fitEffects(const campaign::Campaign& campaign, const RequestedEffects& wanted);

/// What was fitted to diagnosis::spreadForDiagnosis(whole), for the whole day: `day` in the numbers of its postures.
EffectFit overWholeDay(EffectFit spread, const preparation::PreparedCampaign& whole);

/// Puts sizes that were changed after the fit into what is stated of the effects.
void describeSizes(EffectFit& effects);

/// The effects of the machine with their sizes at `parameters`, without those that are zero: what an ElasticArm bears.
std::vector<effects::PresentEffect> machineEffects(const EffectFit& effects, const Eigen::VectorXd& parameters);

/// The same parameters from a sample of the postures, each with its weight: one linear step from where the fit stands.
Eigen::VectorXd parametersFrom(const EffectFit& effects, const std::vector<double>& weights);

}  // namespace stiffscope::extended_model
