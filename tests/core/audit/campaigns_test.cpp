#include <fmt/format.h>
#include <gtest/gtest.h>
#include "core/audit/audit.h"
#include "core/audit/remarks.h"
#include "core/campaign/joint_reading.h"
#include "core/campaign/read_campaign.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"

// The audit of the campaigns kept beside the checkout: their causes are known, and readings alone show some
// of them.

namespace stiffscope {
namespace campaigns_test {

std::filesystem::path shared(const std::string& folder) {
  return std::filesystem::path(STIFFSCOPE_SHARED_DIR) / folder;
}

audit::AuditReport auditOf(const std::string& folder) {
  return audit::audit(campaign::readCampaign(shared(folder)).campaign);
}

std::vector<preparation::AuditCheck> found(const audit::AuditReport& report) {
  std::vector<preparation::AuditCheck> beyond;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict == preparation::AuditVerdict::warn || check.verdict == preparation::AuditVerdict::fail)
      beyond.push_back(check);
  }
  return beyond;
}

bool contains(const Remark& remark, const std::string& part) {
  return reports::words(remark).find(part) != std::string::npos;
}

class PracticeAudit : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared("practice")))
      GTEST_SKIP() << "the practice campaigns are not beside the checkout";
  }
};

TEST_F(PracticeAudit, CleanCampaignsPass) {
  for (const char* number : {"01", "18"}) {
    const audit::AuditReport report = auditOf(fmt::format("practice/{}", number));
    EXPECT_EQ(report.verdict, preparation::AuditVerdict::pass) << number;
    EXPECT_TRUE(report.rejected.empty()) << number;
  }
}

TEST_F(PracticeAudit, OneCauseGivesOneFinding) {
  const std::vector<std::pair<const char*, const char*>> known{{"08", "return_to_zero"},
                                                               {"12", "moment_lever"},
                                                               {"13", "station_drift"},
                                                               {"15", "station_drift"},
                                                               {"16", "rigid_tool"}};
  for (const auto& [number, id] : known) {
    const auto beyond = found(auditOf(fmt::format("practice/{}", number)));
    ASSERT_EQ(beyond.size(), 1u) << number;
    EXPECT_EQ(beyond[0].id, id) << number;
  }
}

TEST_F(PracticeAudit, SaysWhatMoved) {
  EXPECT_TRUE(contains(found(auditOf("practice/13")).at(0).message, "it jumped"));
  EXPECT_TRUE(contains(found(auditOf("practice/15")).at(0).message, "a drift of"));
  const preparation::AuditCheck tool = found(auditOf("practice/16")).at(0);
  EXPECT_TRUE(contains(tool.message, "reflector P12 moves")) << reports::words(tool.message);
  EXPECT_TRUE(contains(tool.where, "P12")) << reports::words(tool.where);
}

TEST(RealSweeps, ReflectorOnTheAxisAndTheShortArc) {
  if (!std::filesystem::exists(shared("real"))) GTEST_SKIP() << "the real campaigns are not beside the checkout";
  const audit::AuditReport report = auditOf("real/fanuc-r2000ic-sweeps");
  bool arc = false, on_axis = false;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == "circle_arc" && check.where == Remark(audit::RemarkId::at_axis, 1)) {
      arc = true;
      EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
      EXPECT_NEAR(*check.value, 60.0 * io::kDegree, 0.1 * io::kDegree);  // six stops of 12 deg
      EXPECT_TRUE(contains(check.message, "urad in direction")) << reports::words(check.message);
      EXPECT_TRUE(contains(check.message, "2.2 times what as many readings over 90 deg"))
          << reports::words(check.message);
    }
    if (check.id == "reflector_on_axis") {
      on_axis = true;
      EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
      EXPECT_EQ(reports::words(check.where), "P10, axis 4; P10, axis 6");
      EXPECT_LT(*check.value, 2e-3);  // m
    }
  }
  EXPECT_TRUE(arc && on_axis);
  EXPECT_FALSE(audit::findsTheImpossible(report));
}

// FANUC shows joint 3 against the horizontal. The sweeps have the URDF's angles; the controller's own figures come back
// by the coupling, and tell by themselves what they are.
TEST(RealSweeps, FiguresAgainstTheHorizontalAreNamedAndRead) {
  if (!std::filesystem::exists(shared("real"))) GTEST_SKIP() << "the real campaigns are not beside the checkout";
  campaign::Campaign raw = campaign::readCampaign(shared("real/fanuc-r2000ic-sweeps")).campaign;
  const std::vector<campaign::JointReading> against_horizontal{{.joint = 2, .plus = 1}};
  raw.joint_readings = against_horizontal;
  campaign::anglesToFigures(raw);

  campaign::Campaign undeclared = raw;
  undeclared.joint_readings.clear();
  const audit::AuditReport unread = audit::audit(undeclared);
  ASSERT_FALSE(unread.suspected.empty());
  EXPECT_EQ(unread.suspected.front().mistake, "joint_coupling");
  EXPECT_TRUE(contains(unread.suspected.front().remedy, "write q3_deg + q2_deg for q3_deg"))
      << reports::words(unread.suspected.front().remedy);

  campaign::figuresToAngles(raw);
  bool compared = false;
  for (const preparation::AuditCheck& check : audit::audit(raw).checks) {
    if (check.id != "arm_model") continue;
    compared = true;
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass);
    EXPECT_NEAR(*check.value, 0.7e-3, 0.1e-3);  // m: this arm and its drawing
  }
  EXPECT_TRUE(compared);
}

}  // namespace campaigns_test
}  // namespace stiffscope
