#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope {

/// What a result says of the campaign: that without its readings, which take megabytes.
Campaign described(const Campaign& campaign);

}  // namespace stiffscope
