#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope {

/// Whether the forces of some load step are three times those of another (rms): a load of couples alone leaves the
/// same noise in all of them, loaded or not, of which no lever and no stiffness follows. The ratio does not ask for
/// units. True of a single step.
bool forcesStandOut(const Campaign& campaign);

}  // namespace stiffscope
