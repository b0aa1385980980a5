// Arms whose joints turn several axes: `mimic` in a URDF, and the closed chain of a parallelogram by its elastic
// energy.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <string>

#include "core/io/input_error.h"
#include "core/robot/geometric_stiffness.h"
#include "core/robot/gravity_load.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/read_urdf.h"
#include "core/robot/wrench.h"

namespace stiffscope {
namespace couplings_test {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kUpper = 1.1, kFore = 1.4;  // m

/// Shoulder at the origin, everything in the plane y = 0; joint 3 turns the forearm against the base through rods.
/// Angles about +y, at zero both links along +x.
std::string urdf(const std::string& mimic) {
  const std::string limit = "<limit lower=\"-3\" upper=\"3\"/>";
  return R"(<robot name="rods"><link name="base"/><link name="l1"/>
<link name="l2"><inertial><origin xyz="0.5 0 0"/><mass value="80"/></inertial></link><link name="rod"/>
<link name="l3"><inertial><origin xyz="0.6 0 0.1"/><mass value="60"/></inertial></link><link name="l4"/><link name="tool"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>)" +
         limit + R"(</joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 1 0"/>)" +
         limit + R"(</joint>
<joint name="rods" type="revolute"><parent link="l2"/><child link="rod"/><origin xyz="1.1 0 0"/><axis xyz="0 1 0"/>)" +
         mimic + "<limit lower=\"-1.5\" upper=\"1\"/>" + R"(</joint>
<joint name="j3" type="revolute"><parent link="rod"/><child link="l3"/><axis xyz="0 1 0"/>)" +
         limit + R"(</joint>
<joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="1.4 0 0"/><axis xyz="1 0 0"/>)" +
         limit + R"(</joint>
<joint name="face" type="fixed"><parent link="l4"/><child link="tool"/></joint></robot>)";
}

robot::Robot arm(const std::string& mimic = "<mimic joint=\"j2\" multiplier=\"-1\"/>") {
  return robot::parseUrdf(urdf(mimic), "rods.urdf", "base", "tool");
}

JointVector posture(double q1, double q2, double q3, double q4 = 0.0) {
  JointVector q(4);
  q << q1, q2, q3, q4;
  return q;
}

Vector3d flange(const robot::Robot& robot, const JointVector& q) {
  return robot::flangeAt(robot, robot::postureAt(robot, q)).translation();
}

TEST(Couplings, AreReadFromMimic) {
  const robot::Robot robot = arm();
  EXPECT_EQ(robot.joints(), 4);
  EXPECT_EQ(robot.axes(), 5);
  ASSERT_TRUE(robot.coupled());
  const robot::ArmAxes& axes = robot.axes_in_base_at_zero;
  EXPECT_EQ(axes.axisOf(2), 3);
  EXPECT_EQ(axes.jointOf(2), -1);
  EXPECT_FALSE(axes.turnsAlone(1));
  EXPECT_TRUE(axes.turnsAlone(2));
  EXPECT_EQ(axes.angles(posture(0.1, 0.2, 0.3, 0.4))[2], -0.2);
  EXPECT_EQ(robot.joint_names.size(), 4u);
  EXPECT_EQ(robot.axis_names[2], "rods");
  // q2 of 1.6 would bring the axis that follows to -1.6, which its own limits do not have.
  EXPECT_TRUE(robot::withinAxisLimits(robot, posture(0, 1.4, 0)));
  EXPECT_FALSE(robot::withinAxisLimits(robot, posture(0, 1.6, 0)));
  EXPECT_TRUE(robot.wristStandsApart());
}

TEST(Couplings, ForearmKeepsItsAngle) {
  const robot::Robot robot = arm();
  for (const double q2 : {-0.7, 0.0, 0.9}) {
    const double q3 = 0.4;
    const Vector3d expected(kUpper * std::cos(q2) + kFore * std::cos(q3), 0,
                            -kUpper * std::sin(q2) - kFore * std::sin(q3));
    EXPECT_LT((flange(robot, posture(0, q2, q3)) - expected).norm(), 1e-14);
  }
}

TEST(Couplings, OffsetIsWhereTheArmStandsAtZero) {
  const robot::Robot plain = arm(), offset = arm("<mimic joint=\"j2\" multiplier=\"-1\" offset=\"0.3\"/>");
  // The offset turns the forearm as joint 3 does.
  EXPECT_LT((flange(offset, posture(0.2, 0.5, 0.1)) - flange(plain, posture(0.2, 0.5, 0.4))).norm(), 1e-14);
  EXPECT_NEAR(offset.axis_limits[2].upper, 1 - 0.3, 1e-15);
}

// Central differences of positions and of the potential: 1e-6 of a step, rounding 1e-10.
TEST(Couplings, JacobianTorqueAndStiffnessAreDerivatives) {
  const robot::Robot robot = arm();
  const JointVector q = posture(0.3, 0.4, -0.2, 0.7);
  const robot::ArmPosture at = robot::postureAt(robot, q);
  const Vector3d force(300, -200, -900), moment(20, 30, -10);
  const robot::GravityLoad weight =
      robot::gravityLoad(robot, std::nullopt, {0, 0, -9.81}, robot, Eigen::Isometry3d::Identity());
  const Jacobian jacobian = robot::jacobianAt(robot, at, flange(robot, q));
  const robot::Wrench pull{flange(robot, q), force, Vector3d::Zero()};
  const JointVector torque = robot::jointTorque(robot, at, pull), own = robot::weightTorque(robot, at, weight);
  const JointMatrix stiffness = robot::geometricStiffness(robot::axesAt(robot, at), pull) +
                                robot::geometricStiffness(robot::axesAt(robot, at), at, weight);
  const auto potential = [&](const JointVector& there) {
    const robot::ArmPosture moved = robot::postureAt(robot, there);
    double sum = 0.0;
    for (std::size_t b = 1; b < weight.bodies.size(); ++b)
      sum +=
          weight.bodies[b].mass_kg * weight.gravity_in_base.dot(moved.motion[b] * weight.bodies[b].com_in_base_at_zero);
    return sum;
  };
  const auto torqueAt = [&](const JointVector& there) -> JointVector {
    const robot::ArmPosture moved = robot::postureAt(robot, there);
    return robot::jointTorque(robot, moved, {flange(robot, there), force, Vector3d::Zero()}) +
           robot::weightTorque(robot, moved, weight);
  };
  constexpr double kStep = 1e-5;
  for (int j = 0; j < 4; ++j) {
    const JointVector up = q + kStep * JointVector::Unit(4, j), down = q - kStep * JointVector::Unit(4, j);
    const Vector3d by = (flange(robot, up) - flange(robot, down)) / (2 * kStep);
    EXPECT_LT((jacobian.col(j).head<3>() - by).norm(), 1e-9);
    EXPECT_NEAR(torque[j], by.dot(force), 1e-6);
    EXPECT_NEAR(own[j], (potential(up) - potential(down)) / (2 * kStep), 1e-5);
    EXPECT_LT((stiffness.col(j) - (torqueAt(up) - torqueAt(down)) / (2 * kStep)).norm(), 1e-4);
  }
  EXPECT_LT((jacobian.transpose() * (Vector6d() << force, moment).finished() -
             robot::jointTorque(robot, at, {flange(robot, q), force, moment}))
                .norm(),
            1e-10);
}

/// A parallelogram as a closed chain: upper arm and crank turn about the shoulder, each on the spring of its drive, the
/// forearm about the elbow, and a rod joins crank and the forearm's lever. Nothing of it is an open chain's: the rod's
/// energy alone ties the forearm to the crank.
struct ClosedChain {
  Vector2d springs, drives;        ///< Nm/rad and rad of upper arm and crank
  double rod = 0.0, crank = 0.25;  ///< N/m, m
  double crank_angle = 2.0;        ///< of crank and lever against the forearm, rad
  Vector2d force;                  ///< at the forearm's end, x and z, N

  static Vector2d along(double angle) { return {std::cos(angle), -std::sin(angle)}; }
  static Vector2d turned(double angle) { return {-std::sin(angle), -std::cos(angle)}; }  ///< derivative of it
  static Vector2d end(const Vector3d& x) { return kUpper * along(x[0]) + kFore * along(x[2]); }

  /// Of the elastic energy less the force's work. x: angles of upper arm, crank (as the forearm would stand) and
  /// forearm.
  Vector3d gradient(const Vector3d& x) const {
    const Vector2d on_crank = crank * along(x[1] + crank_angle);
    const Vector2d on_forearm = kUpper * along(x[0]) + crank * along(x[2] + crank_angle);
    const Vector2d between = on_forearm - on_crank, direction = between.normalized();
    const double pull = rod * (between.norm() - kUpper);
    return {springs[0] * (x[0] - drives[0]) + kUpper * turned(x[0]).dot(pull * direction - force),
            springs[1] * (x[1] - drives[1]) - crank * turned(x[1] + crank_angle).dot(pull * direction),
            crank * turned(x[2] + crank_angle).dot(pull * direction) - kFore * turned(x[2]).dot(force)};
  }

  /// By Newton's steps; their Hessian is of differences, which slows them and changes nothing of where they end.
  Vector3d atRest() const {
    Vector3d x(drives[0], drives[1], drives[1]);
    constexpr double kStep = 1e-6;
    for (int step = 0; step < 40; ++step) {
      Eigen::Matrix3d hessian;
      for (int i = 0; i < 3; ++i) {
        const Vector3d along_i = kStep * Vector3d::Unit(i);
        hessian.col(i) = (gradient(x + along_i) - gradient(x - along_i)) / (2 * kStep);
      }
      x -= hessian.fullPivLu().solve(gradient(x));
    }
    return x;
  }
};

/// Displacement of the forearm's end by the joints' compliances in the model.
Vector2d modelled(const ClosedChain& chain, double rod_compliance) {
  const robot::Robot robot = arm();
  const JointVector q = posture(0, chain.drives[0], chain.drives[1]);
  const robot::ArmPosture at = robot::postureAt(robot, q);
  JointVector compliance = JointVector::Zero(4);
  compliance[1] = 1.0 / chain.springs[0];
  compliance[2] = 1.0 / chain.springs[1] + rod_compliance;
  const robot::Wrench pull{flange(robot, q), {chain.force[0], 0, chain.force[1]}, Vector3d::Zero()};
  const Jacobian jacobian = robot::jacobianAt(robot, at, flange(robot, q));
  const Vector3d moved = (jacobian * compliance.cwiseProduct(robot::jointTorque(robot, at, pull))).head<3>();
  return {moved.x(), moved.z()};
}

// Deflections of a millimetre turn the arm by 5e-4: the linear model is right to about that share of them.
TEST(Couplings, ParallelogramDeflectsAsItsClosedChain) {
  for (const Vector2d& drives : {Vector2d(0.3, -0.2), Vector2d(-0.3, 0.5), Vector2d(1.0, 0.1)}) {
    ClosedChain chain{{4e6, 5e6}, drives, 1e12, 0.25, 2.0, {400, -1200}};
    const Vector2d moved = ClosedChain::end(chain.atRest()) - ClosedChain::end({drives[0], drives[1], drives[1]});
    EXPECT_GT(moved.norm(), 2e-4);
    EXPECT_LT((moved - modelled(chain, 0.0)).norm(), 2e-3 * moved.norm()) << drives.transpose();

    // A rod that gives: of force tau / (crank sin psi), psi between crank and rod, which lies along the upper arm.
    chain.rod = 6e8;
    const double psi = drives[1] + chain.crank_angle - drives[0];
    const double series = 1.0 / (chain.rod * std::pow(chain.crank * std::sin(psi), 2));
    const Vector2d softer = ClosedChain::end(chain.atRest()) - ClosedChain::end({drives[0], drives[1], drives[1]});
    EXPECT_GT((softer - moved).norm(), 0.02 * moved.norm());
    EXPECT_LT((softer - modelled(chain, series)).norm(), 2e-3 * softer.norm()) << drives.transpose();
  }
}

TEST(Couplings, ExpectsAJointOfTheChain) {
  const auto refused = [](const std::string& mimic) {
    try {
      arm(mimic);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("<mimic joint=\"j9\"/>")
                .find("expected a joint between base and flange that has an angle of its own: j1, j2, j3, j4"),
            std::string::npos);
  EXPECT_NE(refused("<mimic multiplier=\"1\"/>").find("joint"), std::string::npos);
  EXPECT_NE(refused("<mimic joint=\"j2\" multiplier=\"0\"/>").find("not 0"), std::string::npos);
}

}  // namespace couplings_test
}  // namespace stiffscope
