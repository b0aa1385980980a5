#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope::diagnosis {

/// How far a campaign's gap lies from what any one effect of the vocabulary can do beside the joint stiffnesses, in
/// units of the noise: the least over the effects of sqrt(left^2 - noise^2) / noise, rms per coordinate, of the
/// deflection or of the unloaded positions, whichever is more; `left` by the diagnosis with that effect alone, parts
/// and form chosen, within its physical bounds. Zero where the campaign cannot be diagnosed.
double distanceFromVocabulary(const campaign::Campaign& campaign);

}  // namespace stiffscope::diagnosis
