#pragma once

#include "core/audit/audit.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// The result of `audit`: verdict, checks with figure and limit (null where not testable), rejected readings.
Json auditJson(const campaign::Campaign& campaign, const audit::AuditReport& report);

/// `pass`, `warn`, `fail` or `not_testable`.
const char* nameOf(preparation::AuditVerdict verdict);

}  // namespace stiffscope::reports
