#pragma once

#include "core/effects/elastic_arm.h"
#include "core/extended_model/extended_model.h"

namespace stiffscope::extended_model {

/// Whether an effect of the machine was added.
bool deflectsByEffects(const EffectFit& effects);

/// What compensation needs of the extended model by one method: the flange at rest on joint springs and with the
/// effects of the machine (ElasticArm; hysteresis: the load put on once, from none; a plate: the flange as the tool
/// beyond it carries it), in the method's geometry. Load-point errors are in the campaign's load cell
/// (ExtendedModel::campaign), which the wrench is to be taken from. Uncertainty: springs at given effects, and each
/// column of the effects' spread with what it does to the springs. `model` must outlive the result.
effects::EffectDeflection effectDeflection(const ExtendedModel& model, identification::Method method);

}  // namespace stiffscope::extended_model
