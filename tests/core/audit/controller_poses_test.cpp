#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/audit/audit.h"
#include "core/io/units.h"
#include "core/mistakes/controller_agreement.h"
#include "core/robot/kinematics.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/unloaded_day.h"

// The URDF against the poses that a controller states. Poses are of the tests' own chain arm, joint by joint; the
// controller rounds what it states to thousandths of a millimetre and of a degree.

namespace stiffscope {
namespace controller_poses_test {

using campaign::ControllerModel;
using preparation::AuditVerdict;

constexpr double kTrusted = 0.2e-3;

double rounded(double value, double unit) { return unit * std::round(value / unit); }

/// A day whose controller computes with an arm of its own and, where `sags`, its weight on its joints.
struct StatedDay {
  ChainArm controllers = exampleChain();
  bool sags = false;
  Eigen::Isometry3d user_from_base =
      Eigen::Translation3d(0.3, -1.2, -0.94) * Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d flange_from_tool =
      Eigen::Translation3d(0.05, -0.12, 0.31) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.6, 0.0, 0.8));
  campaign::Campaign campaign;

  StatedDay() {
    Noise noise(7);
    campaign = unloadedCampaign({}, noise);
  }

  campaign::StatedPose poseAt(const JointVector& q) const {
    JointVector bent = q;
    if (sags) bent += exampleCompliance().cwiseProduct(controllers.weightTorque(q));
    const Eigen::Isometry3d pose = user_from_base * controllers.flangeAt(bent) * flange_from_tool;
    campaign::StatedPose stated;
    const Eigen::Vector3d turns = pose.linear().eulerAngles(2, 1, 0);  // Rz(r) Ry(p) Rx(w)
    for (int k = 0; k < 3; ++k) {
      stated.position[k] = rounded(pose.translation()[k], 1e-6);
      stated.rpy[k] = rounded(turns[2 - k], 1e-3 * io::kDegree);
    }
    return stated;
  }

  /// Its joints and poses as the controller writes them.
  void state() {
    for (campaign::State& row : campaign.states->rows) {
      for (int j = 0; j < 6; ++j) row.q[j] = rounded(row.q[j], 1e-3 * io::kDegree);
      row.extras().tool_pose = poseAt(row.q);
    }
  }
};

preparation::AuditCheck checkOf(const campaign::Campaign& campaign) {
  for (const preparation::AuditCheck& check : audit::audit(campaign).checks) {
    if (check.id == "controller_poses") return check;
  }
  throw std::out_of_range("no such check");
}

mistakes::ControllerAgreement agreementOf(const campaign::Campaign& campaign) {
  return mistakes::controllerAgreement(campaign, kTrusted);
}

bool names(const std::vector<mistakes::Suspected>& suspected, const std::string& mistake, const std::string& remedy) {
  for (const mistakes::Suspected& one : suspected) {
    if (one.mistake == mistake && reports::words(one.remedy).find(remedy) != std::string::npos) return true;
  }
  return false;
}

std::string said(const preparation::AuditCheck& check) { return reports::words(check.message); }

TEST(ControllerPoses, OfTheUrdfsArmAgreeWhateverToolAndFrameAre) {
  StatedDay day;
  day.state();
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::pass) << said(check);
  // The joints are those that the pose is of. What is rounded of the pose: 0.3 um a coordinate, and turns of 5e-6 rad
  // at 0.1 m.
  EXPECT_LT(*check.value, 2e-6);
  EXPECT_GT(*check.value, 0.1e-6);
}

TEST(ControllerPoses, PositionsAloneServe) {
  StatedDay day;
  day.state();
  for (campaign::State& row : day.campaign.states->rows) row.extras().tool_pose.rpy.setConstant(campaign::kNotGiven);
  EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::pass);
  for (campaign::State& row : day.campaign.states->rows) row.q[2] -= row.q[1];
  EXPECT_TRUE(names(agreementOf(day.campaign).cures, "joint_coupling", "q3_deg + q2_deg"));
}

TEST(ControllerPoses, ACouplingIsNamed) {
  StatedDay day;
  day.state();
  for (campaign::State& row : day.campaign.states->rows) row.q[2] -= row.q[1];
  const mistakes::ControllerAgreement found = agreementOf(day.campaign);
  EXPECT_GT(*found.miss, 0.1);
  ASSERT_EQ(found.cures.size(), 1u);
  EXPECT_TRUE(names(found.cures, "joint_coupling", "q3_deg + q2_deg")) << reports::words(found.cures[0].remedy);
  EXPECT_LT(found.cures[0].after, kTrusted);
  EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::fail);
  // The readings of the day say the same, and it is named once.
  const audit::AuditReport report = audit::audit(day.campaign);
  int named = 0;
  for (const mistakes::Suspected& one : report.suspected) named += one.mistake == "joint_coupling" ? 1 : 0;
  EXPECT_EQ(named, 1);
}

TEST(ControllerPoses, ASignIsNamed) {
  for (const int joint : {0, 1, 2, 3}) {
    StatedDay day;
    day.state();
    for (campaign::State& row : day.campaign.states->rows) row.q[joint] *= -1.0;
    EXPECT_TRUE(names(agreementOf(day.campaign).cures, "joint_sign", "q" + std::to_string(joint + 1) + "_deg"))
        << joint;
  }
}

TEST(ControllerPoses, ALinkOfAnotherLengthIsNamed) {
  // From a type's sister to a revision: the fore-arm, the upper arm, the shoulder.
  for (const double longer : {0.150, 5e-3, 1e-3}) {
    StatedDay day;
    day.controllers.to_joint[2].translation().z() += longer;
    day.state();
    const mistakes::ControllerAgreement found = agreementOf(day.campaign);
    ASSERT_FALSE(found.cures.empty()) << longer;
    EXPECT_EQ(found.cures[0].mistake, "robot_origin");
    const std::string remedy = reports::words(found.cures[0].remedy);
    EXPECT_NE(remedy.find("joint 3"), std::string::npos) << remedy;
    EXPECT_NE(remedy.find(longer > 0.1 ? "150)" : longer > 2e-3 ? "5.00)" : "1.00)"), std::string::npos) << remedy;
    EXPECT_LT(found.cures[0].after, kTrusted + 1e-3 * longer);
    EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::fail);
  }
}

TEST(ControllerPoses, AnotherGeometryIsAnAccuracyModel) {
  StatedDay day;
  Noise noise(11);
  day.controllers = exampleChain().disturbed(noise, 0.5e-3, 0.3e-3);
  day.state();
  const mistakes::ControllerAgreement found = agreementOf(day.campaign);
  EXPECT_TRUE(found.cures.empty());
  EXPECT_GT(*found.miss, kTrusted);
  ASSERT_TRUE(found.geometry_miss);
  EXPECT_LT(*found.geometry_miss, 40e-6);  // far below the machine's error, above the digits

  preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_NE(said(check).find("another geometry"), std::string::npos) << said(check);
  day.campaign.controller_model = ControllerModel::absolute_accuracy;
  EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::pass);
  day.campaign.controller_model = ControllerModel::nominal;
  check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_NE(said(check).find("declared nominal"), std::string::npos) << said(check);
}

TEST(ControllerPoses, AModelThatSagsIsToldFromGeometry) {
  StatedDay day;
  day.sags = true;
  day.state();
  const mistakes::ControllerAgreement found = agreementOf(day.campaign);
  EXPECT_TRUE(found.cures.empty());
  ASSERT_TRUE(found.geometry_miss && found.elastic_miss);
  EXPECT_LT(*found.elastic_miss, 0.25 * *found.geometry_miss);
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_NE(said(check).find("model sags"), std::string::npos) << said(check);
}

TEST(ControllerPoses, ADeclaredAccuracyModelThatIsNotSeenWarns) {
  StatedDay day;
  day.state();
  day.campaign.controller_model = ControllerModel::absolute_accuracy;
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_NE(said(check).find("the option is off"), std::string::npos) << said(check);
  day.campaign.controller_model = ControllerModel::nominal;
  EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::pass);
}

TEST(ControllerPoses, TurnsOfAnotherConventionAreSaid) {
  StatedDay day;
  day.state();
  // A, B, C of KUKA turn about z, y, x: written in that order they are none of the columns'.
  for (campaign::State& row : day.campaign.states->rows)
    std::swap(row.extras().tool_pose.rpy.x(), row.extras().tool_pose.rpy.z());
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_NE(said(check).find("no turns about the fixed x, y and z axes"), std::string::npos) << said(check);
}

TEST(ControllerPoses, JointsThatStandStillAreNamed) {
  StatedDay day;
  for (campaign::State& row : day.campaign.states->rows) row.q[0] = row.q[3] = row.q[5] = 0.0;
  day.state();
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::pass) << said(check);
  EXPECT_NE(said(check).find("joints 1, 4, 6 stand still"), std::string::npos) << said(check);
}

TEST(ControllerPoses, NoneOrFewAreNotTestable) {
  StatedDay day;
  EXPECT_EQ(checkOf(day.campaign).verdict, AuditVerdict::not_testable);
  day.state();
  for (std::size_t i = 5; i < day.campaign.states->rows.size(); ++i)
    day.campaign.states->rows[i].extras().tool_pose = campaign::StatedPose{};
  const preparation::AuditCheck check = checkOf(day.campaign);
  EXPECT_EQ(check.verdict, AuditVerdict::not_testable);
  EXPECT_NE(said(check).find("5 postures"), std::string::npos) << said(check);
}

}  // namespace controller_poses_test
}  // namespace stiffscope
