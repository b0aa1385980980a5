#include "core/audit/check_design.h"

#include <gtest/gtest.h>
#include "reports/words/remark_words.h"

#include "core/effects/remarks.h"

namespace stiffscope {
namespace separable_effects_test {

audit::AuditReport withPostureSet() {
  audit::AuditReport report;
  preparation::AuditCheck check;
  check.id = "posture_set";
  report.checks.push_back(check);
  return report;
}

TEST(SeparableEffects, AreAddedToThePostureSet) {
  diagnosis::Diagnosis diagnosis;
  diagnosis.usable = true;
  diagnosis.aliases = {{effects::Effect::bearing_tilt, effects::Effect::link_compliance}};
  diagnosis.not_testable = {{effects::Effect::hysteresis, Remark(effects::RemarkId::hysteresis_needs_return_to_zero)}};
  audit::AuditReport report = withPostureSet();
  audit::addSeparableEffects(diagnosis, false, report);
  const auto& details = report.checks[0].details;
  ASSERT_EQ(details.size(), 3u);
  const std::string apart = reports::words(details[0]);
  EXPECT_NE(apart.find("base_compliance, joint_coupling"), std::string::npos) << apart;
  EXPECT_EQ(apart.find("hysteresis"), std::string::npos) << apart;
  EXPECT_EQ(apart.find("bearing_tilt"), std::string::npos) << apart;
  EXPECT_EQ(reports::words(details[1]), "effects that could not always be told apart: bearing_tilt or link_compliance");
  EXPECT_EQ(reports::words(details[2]),
            "effects that cannot be tested here (diagnose says what is missing): hysteresis");
}

TEST(SeparableEffects, NothingWithoutADiagnosis) {
  audit::AuditReport report = withPostureSet();
  audit::addSeparableEffects(diagnosis::Diagnosis{}, false, report);
  EXPECT_TRUE(report.checks[0].details.empty());
}

}  // namespace separable_effects_test
}  // namespace stiffscope
