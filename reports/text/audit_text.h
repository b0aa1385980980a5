#pragma once

#include <string>

#include "core/audit/audit.h"

namespace stiffscope {

/// The audit for people: a table of the checks, then what those that did not pass say, then the rejected
/// readings.
std::string auditText(const Campaign& campaign, const AuditReport& report);

}  // namespace stiffscope
