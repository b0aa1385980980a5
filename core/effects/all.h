#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/effect_model.h"

namespace stiffscope::effects {

// One function an effect, named in the table of effect.h and defined in the effect's file with its equation,
// source and bounds: `const EffectRecord& bearingTilt();` and so on.
#define STIFFSCOPE_EFFECT_RECORD(id, record) const EffectRecord& record();
STIFFSCOPE_EFFECTS(STIFFSCOPE_EFFECT_RECORD)
#undef STIFFSCOPE_EFFECT_RECORD

const EffectRecord& recordOf(Effect effect);

/// The models of one effect, which carry its id.
std::vector<EffectModel> modelsOf(const EffectRecord& record, const ModelScope& scope = {});

/// The models that a diagnosis tries, one or more an effect, in the order of the table.
std::vector<EffectModel> effectModels(const ModelScope& scope);

/// How soft an arm is as a whole, rad/Nm: by what its reflectors move under load, over the force and the square of the
/// flange's distance from base_link's origin; the median over loaded states. Of drawn arms 1e-7 to 6e-6 where
/// they are industrial, 2e-5 to 1e-4 where they work beside people. 0 without loaded states. What bounds the size of an
/// effect grows with it.
double armCompliance(const campaign::Campaign& campaign);

/// The same for the campaign's machine and reflectors.
std::vector<EffectModel> effectModelsOf(const campaign::Campaign& campaign);

EffectNature natureOf(Effect effect);

/// Whether a machine of this kind can have the effect at all.
bool concerns(Effect effect, bool on_rail);

/// Whether the effect has a part in what the machine does under a planned load.
bool entersCompensation(Effect effect);

/// What is missing to test an effect with this; empty where nothing is.
Remark missingFor(Effect effect, const CampaignContents& contents);

}  // namespace stiffscope::effects
