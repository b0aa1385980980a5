#include "core/audit/check_design.h"

#include <gtest/gtest.h>

#include "core/effects/remarks.h"

namespace stiffscope {
namespace {

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
  audit::addSeparableEffects(diagnosis, report);
  const auto& details = report.checks[0].details;
  ASSERT_EQ(details.size(), 3u);
  EXPECT_NE(details[0].find("base_compliance, joint_coupling"), std::string::npos) << details[0];
  EXPECT_EQ(details[0].find("hysteresis"), std::string::npos) << details[0];
  EXPECT_EQ(details[0].find("bearing_tilt"), std::string::npos) << details[0];
  EXPECT_EQ(details[1], "effects that could not always be told apart: bearing_tilt or link_compliance");
  EXPECT_EQ(details[2], "effects that cannot be tested here (diagnose says what is missing): hysteresis");
}

TEST(SeparableEffects, NothingWithoutADiagnosis) {
  audit::AuditReport report = withPostureSet();
  audit::addSeparableEffects(diagnosis::Diagnosis{}, report);
  EXPECT_TRUE(report.checks[0].details.empty());
}

}  // namespace
}  // namespace stiffscope
