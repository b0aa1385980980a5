#pragma once

#include "core/improved/improved_model.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// `with`: the effects added to the joint springs, what they explain, and each method without and with them.
Json improvedJson(const ImprovedModel& model, const std::vector<Method>& methods);

/// A result with that key.
Json withEffects(Json json, const ImprovedModel& model, const std::vector<Method>& methods);

}  // namespace stiffscope
