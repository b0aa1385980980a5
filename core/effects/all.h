#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// The models that a diagnosis tries, one or more an effect. A new effect is a file in effects/ and a line
/// here. kinematic_error has no columns: the geometry is a nuisance of every fit, and what the fit finds is
/// held against the nominal one (see geometry_error.h).
std::vector<EffectModel> effectModels(const std::vector<std::string>& targets);

/// The same with the campaign's reflectors.
std::vector<EffectModel> effectModelsOf(const campaign::Campaign& campaign);

}  // namespace stiffscope::effects
