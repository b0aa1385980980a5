#include "reports/words/day_words.h"

#include <gtest/gtest.h>

namespace stiffscope::reports {
namespace {

audit::AuditReport auditOf(preparation::AuditVerdict verdict, const std::vector<std::string>& ids) {
  audit::AuditReport audit;
  audit.verdict = verdict;
  preparation::AuditCheck passed;
  passed.id = "completeness";
  audit.checks.push_back(passed);
  for (const std::string& id : ids) {
    preparation::AuditCheck check;
    check.id = id;
    check.verdict = verdict;
    audit.checks.push_back(check);
  }
  return audit;
}

TEST(DayWords, TheAuditsSentenceNamesTheChecksThatDecideIt) {
  using preparation::AuditVerdict;
  EXPECT_EQ(
      auditMeaning(auditOf(AuditVerdict::warn, {"repeat_outliers", "repeat_outliers", "lost_beam"}), DayKind::loaded),
      "The audit finds the readings fit to identify from, and warns of repeat outliers, lost beam (see Audit).");
  EXPECT_EQ(auditMeaning(auditOf(AuditVerdict::fail, {"time_order"}), DayKind::unloaded),
            "The audit fails by time order: as they were read, the readings are not fit to calibrate from.");
  EXPECT_EQ(auditMeaning(auditOf(AuditVerdict::warn,
                                 {"lost_beam", "time_order", "nest_outliers", "repeat_outliers", "completeness"}),
                         DayKind::loaded),
            "The audit finds the readings fit to identify from, and warns of 5 checks (see Audit).");
}

}  // namespace
}  // namespace stiffscope::reports
