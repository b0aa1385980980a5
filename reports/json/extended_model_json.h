#pragma once

#include "core/extended_model/extended_model.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// `with`: the effects added to the joint springs, what they explain, and each method without and with them.
Json improvedJson(const extended_model::ImprovedModel& model, const std::vector<identification::Method>& methods);

/// A result with that key.
Json withEffects(Json json, const extended_model::ImprovedModel& model, const std::vector<identification::Method>& methods);

}  // namespace stiffscope::reports
