#include "core/calibration/calibrated_urdf.h"

#include <gtest/gtest.h>

#ifdef STIFFSCOPE_TEST_KDL
#include <urdf_parser/urdf_parser.h>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#endif

#include "core/frames/arm_parameters.h"
#include "core/io/read_file.h"
#include "core/robot/kinematics.h"
#include "core/robot/read_urdf.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace calibrated_urdf_test {

constexpr double kMetres = 1e-9;  // the contract's
const char* const kFiles[] = {"/samples/m900ib700.urdf", "/tests/data/rotated_arm.urdf", "/tests/data/plain_arm.urdf"};

struct Calibrated {
  std::string before, after;
  robot::Robot nominal, arm;
};

/// The URDF of an arm whose axes are off by millimetres and milliradians.
Calibrated calibrated(const std::string& file, Noise& noise) {
  Calibrated result;
  result.before = io::readTextFile(file, io::kLargestXml);
  result.nominal = robot::parseUrdf(result.before, file, "base_link", "tool0");
  frames::LoadingGeometry geometry;
  geometry.arm = result.nominal;
  const frames::ArmParameters at(result.nominal.joints());
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(at.count(0));
  for (int k = 0; k < at.axes(); ++k) steps[k] = 2e-3 * noise.normal();
  result.arm = frames::moved(geometry, steps, Eigen::Vector3d::Zero()).arm;
  result.after = calibration::calibratedUrdf(result.before, file, "base_link", "tool0", result.nominal, result.arm);
  return result;
}

TEST(CalibratedUrdf, ReadsBackAsTheCalibratedArm) {
  Noise noise(1);
  for (const char* name : kFiles) {
    SCOPED_TRACE(name);
    const Calibrated one = calibrated(std::string(STIFFSCOPE_SOURCE_DIR) + name, noise);
    const robot::Robot read = robot::parseUrdf(one.after, "calibrated.urdf", "base_link", "tool0");
    for (int k = 0; k < 1000; ++k) {
      const JointVector q = JointVector::NullaryExpr(6, [&] { return 6.0 * (noise.uniform() - 0.5); });
      const Eigen::Isometry3d by_file = robot::flangeAt(read, robot::postureAt(read, q)),
                              by_fit = robot::flangeAt(one.arm, robot::postureAt(one.arm, q));
      ASSERT_LT((by_file.translation() - by_fit.translation()).norm(), kMetres);
      ASSERT_LT((by_file.linear() - by_fit.linear()).norm(), kMetres);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_EQ(read.joint_names[j], one.nominal.joint_names[j]);
      EXPECT_EQ(read.limits[j].upper, one.nominal.limits[j].upper);
      EXPECT_EQ(read.bodies[j + 1].mass_kg, one.nominal.bodies[j + 1].mass_kg);
    }
  }
}

TEST(CalibratedUrdf, KeepsCommentsAndWhatIsNotOfTheChain) {
  Noise noise(2);
  const Calibrated one = calibrated(std::string(STIFFSCOPE_SOURCE_DIR) + kFiles[0], noise);
  EXPECT_NE(one.after.find("Not the maker's file."), std::string::npos);
  EXPECT_NE(one.after.find("<inertia ixx=\"60\" iyy=\"85\""), std::string::npos);
  const auto count = [](const std::string& text, const std::string& what) {
    int found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  for (const char* what : {"<link", "<joint", "<axis", "<limit", "<inertial", "<!--"})
    EXPECT_EQ(count(one.before, what), count(one.after, what)) << what;
}

#ifdef STIFFSCOPE_TEST_KDL
/// The flange as urdfdom reads the file and KDL moves it.
TEST(CalibratedUrdf, UrdfdomAndKdlMoveTheFlangeAsFitted) {
  Noise noise(3);
  for (const char* name : kFiles) {
    SCOPED_TRACE(name);
    const Calibrated one = calibrated(std::string(STIFFSCOPE_SOURCE_DIR) + name, noise);
    const auto model = urdf::parseURDF(one.after);
    ASSERT_TRUE(model);
    KDL::Chain chain;
    std::vector<urdf::LinkConstSharedPtr> links;
    for (auto link = model->getLink("tool0"); link && link->name != "base_link"; link = link->getParent())
      links.insert(links.begin(), link);
    for (const auto& link : links) {
      const urdf::Joint& joint = *link->parent_joint;
      const urdf::Pose& pose = joint.parent_to_joint_origin_transform;
      const KDL::Frame origin(
          KDL::Rotation::Quaternion(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z));
      const KDL::Vector axis(joint.axis.x, joint.axis.y, joint.axis.z);
      const bool fixed = joint.type == urdf::Joint::FIXED;
      chain.addSegment(KDL::Segment(fixed ? KDL::Joint(joint.name, KDL::Joint::None)
                                          : KDL::Joint(joint.name, origin.p, origin.M * axis, KDL::Joint::RotAxis),
                                    origin));
    }
    ASSERT_EQ(chain.getNrOfJoints(), 6u);
    KDL::ChainFkSolverPos_recursive place(chain);
    for (int k = 0; k < 1000; ++k) {
      const JointVector q = JointVector::NullaryExpr(6, [&] { return 6.0 * (noise.uniform() - 0.5); });
      KDL::JntArray joints(6);
      joints.data = q;
      KDL::Frame flange;
      ASSERT_GE(place.JntToCart(joints, flange), 0);
      const Eigen::Isometry3d fitted = robot::flangeAt(one.arm, robot::postureAt(one.arm, q));
      ASSERT_LT((Eigen::Vector3d(flange.p.x(), flange.p.y(), flange.p.z()) - fitted.translation()).norm(), kMetres);
    }
  }
}
#endif

}  // namespace calibrated_urdf_test
}  // namespace stiffscope
