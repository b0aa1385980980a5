#pragma once

#include <optional>

#include "app/view/view_material.h"
#include "core/campaign/campaign.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// Every posture under every load step, the scenes by the code of the report's deflection picture. Vectors
/// are predicted by `method` with the stiffnesses of `identified`, from whichever step they were identified;
/// none: measured vectors only.
ViewMaterial loadMaterial(const Campaign& campaign, const Identification& identified,
                          std::optional<Method> method);

}  // namespace stiffscope
