#pragma once

#include <optional>
#include <string>

#include "core/preparation/finding.h"

namespace stiffscope::reports {

/// What a check found, its limit and their unit as people read them: core has SI units.
struct AuditFigures {
  std::optional<double> value, limit;
  std::string unit;  ///< empty where there is neither
};

AuditFigures figuresOf(const preparation::AuditCheck& check);

}  // namespace stiffscope::reports
