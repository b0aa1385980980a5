#include "core/audit/finding.h"

namespace stiffscope {

AuditCheck notTestable(const std::string& id, const std::string& missing) {
  AuditCheck check;
  check.id = id;
  check.verdict = AuditVerdict::not_testable;
  check.message = missing;
  return check;
}

}  // namespace stiffscope
