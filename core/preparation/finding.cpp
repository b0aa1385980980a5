#include "core/preparation/finding.h"

#include <utility>

#include "core/campaign/row_names.h"
#include "core/preparation/remarks.h"

namespace stiffscope::preparation {

AuditCheck notTestable(const std::string& id, Remark missing) {
  AuditCheck check;
  check.id = id;
  check.verdict = AuditVerdict::not_testable;
  check.message = std::move(missing);
  return check;
}

Remark byChance(Remark statistic) { return Remark(RemarkId::by_chance, std::move(statistic)); }

Remark atRow(const std::string& file, std::size_t line) {
  return Remark(RemarkId::at_name, campaign::rowName(file, line));
}

}  // namespace stiffscope::preparation
