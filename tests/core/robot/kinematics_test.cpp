#include "core/robot/kinematics.h"

#include <gtest/gtest.h>

#include <sstream>
#include "core/robot/read_urdf.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace kinematics_test {

double apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return (a.matrix() - b.matrix()).norm(); }

Vector6d anyPosture(Noise& noise) {
  return Vector6d::NullaryExpr([&] { return 3.1 * (2.0 * noise.uniform() - 1.0); });
}

TEST(Kinematics, AgainstJointFramesMultipliedOut) {
  Noise noise(1);
  const ChainArm chain = exampleChain().disturbed(noise, 0.1, 0.5);
  const robot::Robot arm = chain.robot();
  const auto at_zero = chain.framesAt(Vector6d::Zero());
  for (int k = 0; k < 200; ++k) {
    const Vector6d q = anyPosture(noise);
    const robot::ArmPosture posture = robot::postureAt(arm, q);
    const auto frames = chain.framesAt(q);
    EXPECT_LT(apart(robot::flangeAt(arm, posture), frames[6]), 1e-13);  // rounding of six products
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_LT(apart(posture.motion[j + 1] * at_zero[j], frames[j]), 1e-13);
      const metrology::Line axis = robot::axisAt(arm, posture, static_cast<int>(j));
      EXPECT_LT((axis.direction - frames[j].linear() * chain.axis[j]).norm(), 1e-13);
      EXPECT_LT((axis.point - frames[j].translation()).norm(), 1e-13);
    }
  }
}

TEST(Kinematics, AgainstAUrdfsTransforms) {
  // Origins with all three angles and oblique axes; the same numbers multiplied out here, R = Rz Ry Rx.
  Noise noise(2);
  ChainArm chain;
  std::ostringstream urdf;
  urdf.precision(17);
  urdf << "<robot name=\"r\"><link name=\"l0\"/>";
  for (int j = 0; j < 7; ++j) {
    const Eigen::Vector3d xyz = 0.4 * noise.normal3(), rpy = noise.normal3(), axis = noise.normal3();
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    origin.translation() = xyz;
    origin.rotate(Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()));
    origin.rotate(Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()));
    origin.rotate(Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
    urdf << "<link name=\"l" << j + 1 << "\"/><joint name=\"j" << j + 1 << "\" type=\""
         << (j < 6 ? "revolute" : "fixed") << "\"><parent link=\"l" << j << "\"/><child link=\"l" << j + 1
         << "\"/><origin xyz=\"" << xyz.transpose() << "\" rpy=\"" << rpy.transpose() << "\"/><axis xyz=\""
         << axis.transpose() << "\"/><limit lower=\"-3\" upper=\"3\"/></joint>";
    if (j == 6) {
      chain.to_flange = origin;
    } else {
      chain.to_joint[static_cast<std::size_t>(j)] = origin;
      chain.axis[static_cast<std::size_t>(j)] = axis.normalized();
    }
  }
  urdf << "</robot>";
  const robot::Robot arm = robot::parseUrdf(urdf.str(), "test.urdf", "l0", "l7");
  for (int k = 0; k < 50; ++k) {
    const Vector6d q = anyPosture(noise);
    EXPECT_LT(apart(robot::flangeAt(arm, robot::postureAt(arm, q)), chain.flangeAt(q)), 1e-13);
  }
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
    const Vector6d q = anyPosture(noise);
    // z1 = -y so that joint 2 (about +y) turns it by -q2; z2 = -y too, joint 3 turns about -y; z3 = x ahead,
    // joint 4 turns about -x; z4 = -y, joint 5 about -y; z5 = x, joint 6 about -x.
    const Eigen::Matrix4d flange = dh(q[0], 0.94, 0.41, kQuarter) * dh(kQuarter - q[1], 0, 1.12, 0) *
                                   dh(q[2], 0, 0.25, kQuarter) * dh(-q[3], 1.285, 0, -kQuarter) *
                                   dh(q[4], 0, 0, kQuarter) * dh(-q[5], 0.3, 0, 0);
    const Eigen::Isometry3d found = robot::flangeAt(arm, robot::postureAt(arm, q));
    EXPECT_LT((found.translation() - flange.topRightCorner<3, 1>()).norm(), 1e-13);
    // The flange's z is along z5 both ways; its x and y are those of DH up to a fixed turn about it.
    EXPECT_LT((found.linear().col(2) - flange.block<3, 1>(0, 2)).norm(), 1e-13);
    const Eigen::Matrix3d at_zero = exampleChain().flangeAt(Vector6d::Zero()).linear();
    const Eigen::Matrix4d dh_zero = dh(0, 0.94, 0.41, kQuarter) * dh(kQuarter, 0, 1.12, 0) * dh(0, 0, 0.25, kQuarter) *
                                    dh(0, 1.285, 0, -kQuarter) * dh(0, 0, 0, kQuarter) * dh(0, 0.3, 0, 0);
    const Eigen::Matrix3d fixed = dh_zero.topLeftCorner<3, 3>().transpose() * at_zero;
    EXPECT_LT((found.linear() - flange.topLeftCorner<3, 3>() * fixed).norm(), 1e-13);
  }
}

TEST(Jacobian, AgainstFiniteDifferencesOfTheChain) {
  Noise noise(4);
  const ChainArm chain = exampleChain().disturbed(noise, 0.1, 0.5);
  const robot::Robot arm = chain.robot();
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 50; ++k) {
    const Vector6d q = anyPosture(noise);
    const Eigen::Vector3d in_flange = 0.3 * noise.normal3();
    const Matrix6d jacobian = robot::jacobianAt(arm, robot::postureAt(arm, q), chain.flangeAt(q) * in_flange);
    for (int j = 0; j < 6; ++j) {
      const Eigen::Isometry3d ahead = chain.flangeAt(q + kStep * Vector6d::Unit(j));
      const Eigen::Isometry3d behind = chain.flangeAt(q - kStep * Vector6d::Unit(j));
      const Eigen::Vector3d velocity = (ahead * in_flange - behind * in_flange) / (2 * kStep);
      const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
      const Eigen::Vector3d rate = turn.angle() * turn.axis() / (2 * kStep);
      // Rounding of 1e-16 m over 2e-6 rad, and the third derivative of 2 m times the step squared: 1e-9
      // together.
      EXPECT_LT((jacobian.block<3, 1>(0, j) - velocity).norm(), 1e-8);
      EXPECT_LT((jacobian.block<3, 1>(3, j) - rate).norm(), 1e-8);
    }
  }
}

}  // namespace kinematics_test
}  // namespace stiffscope
