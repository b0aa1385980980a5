// What the page says beside the audit's findings: where its limits come from, and what of its warnings is the
// machine's.
#include <gtest/gtest.h>

#include <string>
#include "core/audit/remarks.h"
#include "core/diagnosis/diagnosis.h"
#include "core/preparation/finding.h"
#include "reports/page/pages.h"
#include "reports/words/effect_words.h"
#include "reports/words/verdict.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace audit_page_test {

const std::string kShared =
    "Limits by chi-square, normal deviates or Student's t share 1\u00a0% of false findings over the whole audit.";
const std::string kWhy =
    "The audit knows the URDF and joint springs alone: warnings of circles, axes, wrist and unloaded positions can "
    "come "
    "from what the readings show besides, ";

/// A page of one day of which one check warns.
struct Audited {
  SmallResult small;
  audit::AuditReport audit;
  diagnosis::Diagnosis diagnosis{6};

  explicit Audited(const char* check, Remark limit_source) {
    preparation::AuditCheck one;
    one.id = check;
    one.verdict = preparation::AuditVerdict::warn;
    one.value = 2.0, one.limit = 1.0;
    one.message = Remark(audit::RemarkId::at_loading);
    one.limit_source = std::move(limit_source);
    audit.verdict = preparation::AuditVerdict::warn;
    audit.checks.push_back(one);
    diagnosis.usable = true;
    diagnosis::VerdictEntry entry;
    entry.effects = {effects::Effect::bearing_tilt};
    diagnosis.verdict.entries.push_back(entry);
  }

  std::string page(bool diagnosed) const {
    reports::ReportContent content;
    content.title = "A report";
    content.campaigns.push_back({small.campaign, small.identification});
    content.campaigns[0].audit = &audit;
    if (diagnosed) content.campaigns[0].diagnosis = &diagnosis;
    content.verdict = reports::verdictOf(content.campaigns, content.avoided);
    return page::reportPage(content);
  }
};

bool says(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(AuditOnThePage, LimitsByChanceAreSaidToShareIt) {
  EXPECT_TRUE(
      says(Audited("return_to_zero", preparation::byChance(Remark(audit::LimitId::chi_square_and_postures, 144)))
               .page(false),
           kShared));
  EXPECT_FALSE(says(Audited("posture_set", Remark(audit::LimitId::condition_practice)).page(false), kShared));
}

TEST(AuditOnThePage, SaysWhichOfItsWarningsCanBeTheMachines) {
  const Remark limit(audit::LimitId::condition_practice);
  for (const char* check : {"circle_residual", "axis_agreement", "wrist_sphere", "unloaded_positions"}) {
    SCOPED_TRACE(check);
    const Audited machine(check, limit);
    const std::string page = machine.page(true);
    EXPECT_TRUE(says(page, kWhy));
    EXPECT_TRUE(says(page, reports::presentWords(machine.diagnosis.verdict)));
    EXPECT_FALSE(says(machine.page(false), kWhy));  // nothing is known to be there
    Audited nothing = machine;
    nothing.diagnosis.verdict.entries.clear();
    EXPECT_FALSE(says(nothing.page(true), kWhy));
    Audited passed = machine;
    passed.audit.checks[0].verdict = preparation::AuditVerdict::pass;
    EXPECT_FALSE(says(passed.page(true), kWhy));
  }
  // A drawn machine's own effects say nothing of how noisy the readings are.
  EXPECT_FALSE(says(Audited("repeatability_along", limit).page(true), kWhy));
}

}  // namespace audit_page_test
}  // namespace stiffscope
