#pragma once

#include <string>

#include "core/audit/audit.h"

namespace stiffscope::reports {

/// The audit for people: a table of the checks, then what those that did not pass say, then the rejected
/// readings.
std::string auditText(const campaign::Campaign& campaign, const audit::AuditReport& report);

}  // namespace stiffscope::reports
