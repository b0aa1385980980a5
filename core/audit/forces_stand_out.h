#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope {

/// Whether some force of the states is ten standard uncertainties of a reading or more. A load of couples alone
/// leaves forces that are noise, of which no lever and no stiffness follows. True where the uncertainty is not
/// stated.
bool forcesStandOut(const Campaign& campaign);

}  // namespace stiffscope
