#include "core/preparation/finding.h"

namespace stiffscope::preparation {

AuditCheck notTestable(const std::string& id, const std::string& missing) {
  AuditCheck check;
  check.id = id;
  check.verdict = AuditVerdict::not_testable;
  check.message = missing;
  return check;
}

}  // namespace stiffscope::preparation
