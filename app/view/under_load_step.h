#pragma once

#include "core/campaign/campaign.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// Another load step of the same campaign as the stiffnesses of `identified` see it: cases, P_wrist and every
/// available method's rows of that step, with K_c and the middle posture that these stiffnesses imply;
/// estimates and frames as they are. What only an identification has (subsets, judgements) stays empty. A
/// case for which a method has no rows gets empty ones.
Identification underLoadStep(const Campaign& campaign, const Identification& identified, int step);

}  // namespace stiffscope
