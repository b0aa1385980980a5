#include "core/robot/kinematics.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include "core/robot/read_urdf.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace kinematics_test {

double apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return (a.matrix() - b.matrix()).norm(); }

JointVector anyPosture(Noise& noise, int joints = 6) {
  return JointVector::NullaryExpr(joints, [&] { return 3.1 * (2.0 * noise.uniform() - 1.0); });
}

TEST(Kinematics, AgainstJointFramesMultipliedOut) {
  Noise noise(1);
  for (const ChainArm& one : chainsOfAllSizes()) {
    const ChainArm chain = one.disturbed(noise, 0.1, 0.5);
    const robot::Robot arm = chain.robot();
    const auto at_zero = chain.framesAt(chain.noAngles());
    for (int k = 0; k < 200; ++k) {
      const JointVector q = anyPosture(noise, chain.joints());
      const robot::ArmPosture posture = robot::postureAt(arm, q);
      const auto frames = chain.framesAt(q);
      ASSERT_EQ(posture.motion.size(), frames.size());
      EXPECT_LT(apart(robot::flangeAt(arm, posture), frames.back()), 1e-13);  // rounding of a product a joint
      for (std::size_t j = 0; j < chain.axis.size(); ++j) {
        EXPECT_LT(apart(posture.motion[j + 1] * at_zero[j], frames[j]), 1e-13);
        const metrology::Line axis = robot::axisAt(arm, posture, static_cast<int>(j));
        EXPECT_LT((axis.direction - frames[j].linear() * chain.axis[j]).norm(), 1e-13);
        EXPECT_LT((axis.point - frames[j].translation()).norm(), 1e-13);
      }
    }
  }
}

/// Origins with all three angles and oblique axes; the same numbers multiplied out here, R = Rz Ry Rx.
void expectTheUrdfsTransforms(int joints, Noise& noise) {
  ChainArm chain;
  std::ostringstream urdf;
  urdf.precision(17);
  urdf << "<robot name=\"r\"><link name=\"l0\"/>";
  for (int j = 0; j <= joints; ++j) {
    const Eigen::Vector3d xyz = 0.4 * noise.normal3(), rpy = noise.normal3(), axis = noise.normal3();
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    origin.translation() = xyz;
    origin.rotate(Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()));
    origin.rotate(Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()));
    origin.rotate(Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
    urdf << "<link name=\"l" << j + 1 << "\"/><joint name=\"j" << j + 1 << "\" type=\""
         << (j < joints ? "revolute" : "fixed") << "\"><parent link=\"l" << j << "\"/><child link=\"l" << j + 1
         << "\"/><origin xyz=\"" << xyz.transpose() << "\" rpy=\"" << rpy.transpose() << "\"/><axis xyz=\""
         << axis.transpose() << "\"/><limit lower=\"-3\" upper=\"3\"/></joint>";
    if (j == joints) {
      chain.to_flange = origin;
    } else {
      chain.to_joint.push_back(origin);
      chain.axis.push_back(axis.normalized());
    }
  }
  urdf << "</robot>";
  const robot::Robot arm = robot::parseUrdf(urdf.str(), "test.urdf", "l0", "l" + std::to_string(joints + 1));
  for (int k = 0; k < 50; ++k) {
    const JointVector q = anyPosture(noise, joints);
    EXPECT_LT(apart(robot::flangeAt(arm, robot::postureAt(arm, q)), chain.flangeAt(q)), 1e-13);
  }
}

TEST(Kinematics, AgainstAUrdfsTransforms) {
  Noise noise(2);
  for (const int joints : {6, 4, 5, 7, 8}) expectTheUrdfsTransforms(joints, noise);
}

/// Denavit and Hartenberg's matrix, written out: Rz(theta) Tz(d) Tx(a) Rx(alpha).
Eigen::Matrix4d dh(double theta, double d, double a, double alpha) {
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Eigen::Matrix4d m;
  m << ct, -st * ca, st * sa, a * ct,  //
      st, ct * ca, -ct * sa, a * st,   //
      0, sa, ca, d,                    //
      0, 0, 0, 1;
  return m;
}

TEST(Kinematics, AgainstDenavitHartenberg) {
  // The example arm in DH numbers, worked out by hand from its drawing: offsets of theta bring DH's zero to
  // it.
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const robot::Robot arm = exampleChain().robot();
  Noise noise(3);
  for (int k = 0; k < 100; ++k) {
    const JointVector q = anyPosture(noise);
    // z1 = -y so that joint 2 (about +y) turns it by -q2; z2 = -y too, joint 3 turns about -y; z3 = x ahead,
    // joint 4 turns about -x; z4 = -y, joint 5 about -y; z5 = x, joint 6 about -x.
    const Eigen::Matrix4d flange = dh(q[0], 0.94, 0.41, kQuarter) * dh(kQuarter - q[1], 0, 1.12, 0) *
                                   dh(q[2], 0, 0.25, kQuarter) * dh(-q[3], 1.285, 0, -kQuarter) *
                                   dh(q[4], 0, 0, kQuarter) * dh(-q[5], 0.3, 0, 0);
    const Eigen::Isometry3d found = robot::flangeAt(arm, robot::postureAt(arm, q));
    EXPECT_LT((found.translation() - flange.topRightCorner<3, 1>()).norm(), 1e-13);
    // The flange's z is along z5 both ways; its x and y are those of DH up to a fixed turn about it.
    EXPECT_LT((found.linear().col(2) - flange.block<3, 1>(0, 2)).norm(), 1e-13);
    const Eigen::Matrix3d at_zero = exampleChain().flangeAt(exampleChain().noAngles()).linear();
    const Eigen::Matrix4d dh_zero = dh(0, 0.94, 0.41, kQuarter) * dh(kQuarter, 0, 1.12, 0) * dh(0, 0, 0.25, kQuarter) *
                                    dh(0, 1.285, 0, -kQuarter) * dh(0, 0, 0, kQuarter) * dh(0, 0.3, 0, 0);
    const Eigen::Matrix3d fixed = dh_zero.topLeftCorner<3, 3>().transpose() * at_zero;
    EXPECT_LT((found.linear() - flange.topLeftCorner<3, 3>() * fixed).norm(), 1e-13);
  }
}

/// Velocity of a point of the flange and turning rate by each joint, by central differences.
Jacobian differenced(const ChainArm& chain, const JointVector& q, const Eigen::Vector3d& in_flange) {
  constexpr double kStep = 1e-6;
  Jacobian columns(6, chain.joints());
  for (int j = 0; j < chain.joints(); ++j) {
    const JointVector step = kStep * JointVector::Unit(chain.joints(), j);
    const Eigen::Isometry3d ahead = chain.flangeAt(q + step), behind = chain.flangeAt(q - step);
    const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
    columns.col(j) << (ahead * in_flange - behind * in_flange) / (2 * kStep), turn.angle() * turn.axis() / (2 * kStep);
  }
  return columns;
}

TEST(Jacobian, AgainstFiniteDifferencesOfTheChain) {
  Noise noise(4);
  for (const ChainArm& one : chainsOfAllSizes()) {
    const ChainArm chain = one.disturbed(noise, 0.1, 0.5);
    const robot::Robot arm = chain.robot();
    for (int k = 0; k < 50; ++k) {
      const JointVector q = anyPosture(noise, chain.joints());
      const Eigen::Vector3d in_flange = 0.3 * noise.normal3(), point = chain.flangeAt(q) * in_flange;
      const robot::ArmPosture posture = robot::postureAt(arm, q);
      const Jacobian jacobian = robot::jacobianAt(arm, posture, point);
      ASSERT_EQ(jacobian.cols(), chain.joints());
      // Rounding of 1e-16 m over 2e-6 rad, and the third derivative of 2 m times the step squared: 1e-9
      // together.
      EXPECT_LT((jacobian - differenced(chain, q, in_flange)).colwise().norm().maxCoeff(), 1e-8);
      EXPECT_TRUE(robot::pointJacobianAt(robot::axesAt(arm, posture), point) == jacobian.topRows<3>());
    }
  }
}

}  // namespace kinematics_test
}  // namespace stiffscope
