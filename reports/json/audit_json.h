#pragma once

#include "core/audit/audit.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// The result of `audit`: verdict, checks with figure and limit (null where not testable), rejected readings.
Json auditJson(const Campaign& campaign, const AuditReport& report);

/// `pass`, `warn`, `fail` or `not_testable`.
const char* nameOf(AuditVerdict verdict);

}  // namespace stiffscope
