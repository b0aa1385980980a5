#pragma once

#include "core/identification/by_step.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// Adds to a method's object: `coverage`, `interval_nm_per_rad` and `interval_compliance_rad_per_nm` ([low, high], null
/// where open), `dof`, `sd_compliance_rad_per_nm`, `correlation` (6x6, null rows of joints that are not
/// identifiable), `contributions` (standard deviation of the compliance by each part), `bootstrap` where there is one.
void addUncertainty(const MethodResult& method, Json& json);

/// `json` with `by_step`: per method its stiffness by load step, and whether it depends on the load; null where there are
/// no two steps.
Json withSteps(Json json, const StepStudy& study, const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope
