#pragma once

#include "core/campaign/campaign.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// Which campaign a result is of: name, date, robot, double encoder, and the files it was read from with their hashes.
Json campaignJson(const Campaign& campaign);

/// `active`, `inactive` or `unspecified`, as the campaign format spells it.
const char* nameOf(DoubleEncoder state);

}  // namespace stiffscope
