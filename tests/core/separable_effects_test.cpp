#include "core/diagnosis/separable_effects.h"

#include <gtest/gtest.h>

namespace stiffscope {
namespace {

AuditReport withPostureSet() {
  AuditReport report;
  AuditCheck check;
  check.id = "posture_set";
  report.checks.push_back(check);
  return report;
}

TEST(SeparableEffects, AreAddedToThePostureSet) {
  Diagnosis diagnosis;
  diagnosis.usable = true;
  diagnosis.aliases = {{Effect::bearing_tilt, Effect::link_compliance}};
  diagnosis.not_testable = {{Effect::hysteresis, "no return to zero"}};
  AuditReport report = withPostureSet();
  addSeparableEffects(diagnosis, report);
  const auto& details = report.checks[0].details;
  ASSERT_EQ(details.size(), 3u);
  EXPECT_NE(details[0].find("base_compliance, joint_coupling"), std::string::npos) << details[0];
  EXPECT_EQ(details[0].find("hysteresis"), std::string::npos) << details[0];
  EXPECT_EQ(details[0].find("bearing_tilt"), std::string::npos) << details[0];
  EXPECT_EQ(details[1], "effects that could not always be told apart: bearing_tilt or link_compliance");
  EXPECT_EQ(details[2], "effects that cannot be tested here (diagnose says what is missing): hysteresis");
}

TEST(SeparableEffects, NothingWithoutADiagnosis) {
  AuditReport report = withPostureSet();
  addSeparableEffects(Diagnosis{}, report);
  EXPECT_TRUE(report.checks[0].details.empty());
}

}  // namespace
}  // namespace stiffscope
