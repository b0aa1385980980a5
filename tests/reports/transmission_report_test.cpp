#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include "reports/json/identification_json.h"
#include "reports/page/pages.h"
#include "reports/report_content.h"
#include "reports/text/text.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace transmission_report_test {

using identification::HeldSide;
using identification::Method;

/// SmallResult with gears on joints 2 (motor held, half of what DPP sees) and 3 (motor held, more than DPP sees).
struct GearedResult : SmallResult {
  GearedResult() {
    identification::Transmission gears;
    gears.joints.resize(6);
    gears.estimate = identification::StiffnessEstimate(6);
    for (const int joint : {1, 2}) {
      const auto at = static_cast<std::size_t>(joint);
      gears.estimate.identifiable[at] = gears.joints[at].measured = true;
      gears.estimate.compliance[joint] = joint == 1 ? 0.1e-6 : 10e-6;
      gears.estimate.covariance(joint, joint) = gears.estimate.parts.scatter(joint, joint) = 1e-18;
      gears.estimate.scatter_dof[joint] = 100.0;
      gears.joints[at].states = 9, gears.joints[at].postures = 3;
      gears.joints[at].held = HeldSide::motor;
    }
    gears.joints[1].left_out = 1;
    for (const std::size_t at : {std::size_t{0}, std::size_t{3}, std::size_t{4}, std::size_t{5}}) {
      gears.joints[at].reason = Remark(identification::RemarkId::no_second_encoder);
    }
    gears.points = {{0, 1, 1, 1000.0, 1e-4, 1e-6, true}, {1, 1, 1, 500.0, 1e-3, 9e-4, false}};
    // Degrees of freedom enough that ten per cent are known as such.
    for (identification::MethodResult& method : identification.methods) method.estimate.scatter_dof.setConstant(100.0);
    identification.transmission = gears;
  }
};

TEST(TransmissionReport, JsonHasGearsStructureAndAgreement) {
  const GearedResult small;
  const reports::Json json = reports::transmissionJson(
      small.identification, {identification::kMethods.begin(), identification::kMethods.end()});
  const reports::Json& joints = json["joints"];
  ASSERT_EQ(joints.size(), 6u);
  EXPECT_FALSE(joints[0]["measured"].get<bool>());
  EXPECT_NE(joints[0]["reason"].get<std::string>().find("no second encoder"), std::string::npos);
  const reports::Json& second = joints[1];
  EXPECT_NEAR(second["stiffness_nm_per_rad"].get<double>(), 1e7, 1.0);
  EXPECT_NEAR(second["sd_compliance_rad_per_nm"].get<double>(), 1e-9, 1e-15);
  EXPECT_EQ(second["points"], 9);
  EXPECT_EQ(second["held"], "motor_side");
  EXPECT_TRUE(second["structure"].contains("dpp"));
  EXPECT_FALSE(second["structure"].contains("cp"));  // not available
  EXPECT_NEAR(second["structure"]["dpp"]["compliance_rad_per_nm"].get<double>(), 0.1e-6, 1e-15);
  EXPECT_NEAR(second["structure"]["dpp"]["gear_share"].get<double>(), 0.5, 1e-9);
  EXPECT_EQ(second["structure"]["dpp"]["agreement"], "structure_seen");
  EXPECT_EQ(joints[2]["structure"]["dpp"]["agreement"], "contradicts");
}

TEST(TransmissionReport, TextSaysTheDifferenceAndWhatWasLeftOut) {
  const GearedResult small;
  const std::string text = reports::transmissionText(small.identification, {Method::decoupled_partial_pose});
  for (const char* said : {"Gears by their two encoders", "10.0000 +-", "in series", "agree: the tracker sees more",
                           "disagree: the gear alone gives more than the tracker sees", "1 of 10 states left out",
                           "Not measured: joints 1, 4, 5, 6: no second encoder"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said << '\n' << text;
  }
  // Of a day without a tracker the gears stand alone.
  const std::string alone = reports::transmissionText(small.identification, {});
  EXPECT_NE(alone.find("10.0000 +-"), std::string::npos);
  EXPECT_EQ(alone.find("structure"), std::string::npos);
}

TEST(TransmissionReport, PageHasItsSectionTableAndFilesOnlyWithSecondEncoders) {
  const GearedResult geared;
  const SmallResult plain;
  const auto pageOf = [](const SmallResult& small) {
    reports::ReportContent content;
    content.title = "A report";
    content.campaigns.push_back({small.campaign, small.identification});
    return page::makeReportPage(content);
  };
  const auto fileOf = [](const page::ReportPage& page, const std::string& name) -> std::string {
    for (const reports::TableFile& table : page.tables) {
      if (table.name == name) return table.csv;
    }
    return {};
  };
  const page::ReportPage with = pageOf(geared), without = pageOf(plain);
  EXPECT_NE(with.html.find("<section id=\"transmission\">"), std::string::npos);
  EXPECT_NE(with.html.find("disagree: the gear alone"), std::string::npos);
  EXPECT_EQ(without.html.find("transmission"), std::string::npos);
  EXPECT_FALSE(fileOf(with, "transmission").empty());
  const std::string points = fileOf(with, "transmission-points");
  EXPECT_EQ(points.rfind("pose,step,joint,torque_nm,torsion_rad,residual_rad,used", 0), 0u);
  EXPECT_NE(points.find("A,1,2,1000,0.0001,"), std::string::npos) << points;
}

}  // namespace transmission_report_test
}  // namespace stiffscope
