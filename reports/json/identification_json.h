#pragma once

#include "core/identification/identify.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json_document.h"

namespace stiffscope {

/// The result of `identify`, which has to live as long, as the campaign has: rows of the postures are made as they are
/// written. `methods` may leave some out: those asked for.
JsonDocument identificationJson(const Campaign& campaign, const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope
