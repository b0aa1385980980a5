#pragma once

#include <vector>

#include "core/audit/prepare.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// What was done to the readings: raw, rejected readings with file, line and reason, and the station's drift
/// as it was taken off, or why it was not.
Json preparationJson(const Preparation& preparation);

/// A result with `preparation` added: what was done to the readings that it comes from.
Json withPreparation(Json result, const Preparation& preparation);

/// The list that the audit and the preparation share.
Json rejectedJson(const std::vector<RejectedReading>& rejected);

}  // namespace stiffscope
