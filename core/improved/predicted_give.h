#pragma once

#include "core/compensation/further_give.h"
#include "core/improved/improved_model.h"

namespace stiffscope {

/// Whether an effect of the machine was added.
bool givesFurther(const EffectFit& effects);

/// What compensation needs of the improved model by one method: the flange at rest on joint springs and with the effects
/// of the machine (ImprovedArm; hysteresis: the load put on once, from none; a plate: the flange as the tool beyond it
/// carries it), in the method's geometry. Load-point errors are in the campaign's load cell (ImprovedModel::campaign),
/// which the wrench is to be taken from. Uncertainty: springs at given effects, and each column of the effects' spread
/// with what it does to the springs. `model` must outlive the result.
FurtherGive furtherGive(const ImprovedModel& model, Method method);

}  // namespace stiffscope
