#pragma once

#include <optional>
#include <string>

#include "core/preparation/finding.h"

namespace stiffscope::reports {

/// What a check found, its limit and their unit as people read them: core has SI units.
struct AuditFigures {
  std::optional<double> value, limit;
  std::string unit;  ///< empty where there is neither
  /// Below the limit it warns, and not beyond it: the limit is "at least", not "at most".
  bool least = false;
};

AuditFigures figuresOf(const preparation::AuditCheck& check);

}  // namespace stiffscope::reports
