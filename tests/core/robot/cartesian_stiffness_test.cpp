#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include "core/effects/elastic_arm.h"
#include "core/identification/posture_stiffness.h"
#include "core/robot/cartesian_stiffness.h"
#include "core/robot/geometric_stiffness.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace cartesian_stiffness_test {

/// Axes 1 and 2 of the arm as a planar two-bar arm in the x-y plane, bars of length a and b along x at zero;
/// the other axes pass through the flange and are rigid.
robot::Robot planarArm(double a, double b) {
  robot::Robot arm;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  arm.axes_in_base_at_zero = {metrology::Line{{0, 0, 0}, z},     metrology::Line{{a, 0, 0}, z},
                              metrology::Line{{a + b, 0, 0}, y}, metrology::Line{{a + b, 0, 0}, x},
                              metrology::Line{{a + b, 0, 0}, y}, metrology::Line{{a + b, 0, 0}, x}};
  arm.base_from_flange_at_zero.translation() << a + b, 0, 0;
  return arm;
}

TEST(CartesianStiffness, TwoBarArmByHand) {
  // Elbow at 90 deg, bars 1 m and 0.5 m along x and y: the tip stands at (1, 0.5), 0.5 m beyond the elbow. A
  // turn of joint 1 moves it by (-0.5, 1), of joint 2 by (-0.5, 0), so C = c1 [0.25 -0.5; -0.5 1] + c2 [0.25
  // 0; 0 0].
  const robot::Robot arm = planarArm(1.0, 0.5);
  JointVector q = JointVector::Zero(6), c = JointVector::Zero(6);
  q[1] = std::numbers::pi / 2.0;
  c.head<2>() << 1e-6, 4e-6;
  const robot::ArmPosture posture = robot::postureAt(arm, q);
  const Eigen::Vector3d tip = robot::flangeAt(arm, posture).translation();
  const robot::CartesianStiffness found = robot::cartesianStiffness(tip, robot::jacobianAt(arm, posture, tip), c);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected.topLeftCorner<2, 2>() << 1.25e-6, -0.5e-6, -0.5e-6, 1e-6;
  EXPECT_LT((found.compliance.topLeftCorner<3, 3>() - expected).norm(),
            1e-20);  // rounding of numbers near 1e-6
  EXPECT_LT((found.point - Eigen::Vector3d(1.0, 0.5, 0.0)).norm(), 1e-15);
  // Eigenvalues of the 2 x 2 block: 1.125e-6 +- sqrt(0.125^2 + 0.5^2)e-6.
  const double root = std::sqrt(0.125 * 0.125 + 0.25);
  EXPECT_NEAR(found.principal[0].stiffness, 1e6 / (1.125 + root), 1e-6);
  EXPECT_NEAR(found.principal[1].stiffness, 1e6 / (1.125 - root), 1e-6);
  EXPECT_TRUE(std::isinf(found.principal[2].stiffness));  // nothing gives across the plane
  EXPECT_NEAR(std::abs(found.principal[2].direction.z()), 1.0, 1e-12);
  EXPECT_NEAR(found.principal[0].direction.dot(found.principal[1].direction), 0.0, 1e-12);
  EXPECT_FALSE(found.invertible);  // four joints count as rigid
  EXPECT_TRUE(found.stiffness.isZero());
}

/// An arm with its wrist away from straight, and a load on it.
struct LoadedExample {
  ChainArm chain = exampleChain();
  frames::LoadingGeometry geometry;
  JointVector q, c = exampleCompliance();
  Eigen::Vector3d tcp{0.0, 0.0, 0.1};
  effects::FlangeLoad load{{0.05, -0.1, 0.4}, {400.0, -700.0, -1500.0}, Eigen::Vector3d::Zero()};

  explicit LoadedExample(std::uint64_t seed) {
    Noise noise(seed);
    q = somePosture(noise);
    geometry.arm = chain.robot();
  }
  robot::ArmPosture rest(const effects::FlangeLoad& by) const {
    return robot::postureAt(geometry.arm, effects::loadedAngles(geometry, c, q, by).value());
  }
  Eigen::Vector3d tip(const effects::FlangeLoad& by) const { return robot::flangeAt(geometry.arm, rest(by)) * tcp; }
};

TEST(CartesianStiffness, IsTheDerivativeOfTheEquilibriumWithKc) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const LoadedExample arm(seed);
    const robot::ArmPosture posture = arm.rest(arm.load);
    const Eigen::Isometry3d flange = robot::flangeAt(arm.geometry.arm, posture);
    const robot::Wrench wrench{flange * arm.load.point_in_flange, arm.load.force, arm.load.moment};
    const JointMatrix kc = robot::geometricStiffness(robot::axesAt(arm.geometry.arm, posture), wrench);
    // The force changes at its own point: C_x there.
    const Jacobian jacobian = robot::jacobianAt(arm.geometry.arm, posture, wrench.point);
    const robot::CartesianStiffness with = robot::cartesianStiffness(wrench.point, jacobian, arm.c, kc);
    const robot::CartesianStiffness without = robot::cartesianStiffness(wrench.point, jacobian, arm.c);
    Eigen::Matrix3d measured;
    constexpr double kStep = 10.0;  // N: displacements of 1e-4 m against an equilibrium settled to 1e-12
    for (int axis = 0; axis < 3; ++axis) {
      effects::FlangeLoad more = arm.load, less = arm.load;
      more.force[axis] += kStep, less.force[axis] -= kStep;
      const auto hook = [&](const effects::FlangeLoad& by) -> Eigen::Vector3d {
        return robot::flangeAt(arm.geometry.arm, arm.rest(by)) * arm.load.point_in_flange;
      };
      measured.col(axis) = (hook(more) - hook(less)) / (2.0 * kStep);
    }
    const double scale = measured.norm();
    // Central differences over 10 N leave the square of a hundredth of the load's own second order: under
    // 1e-6.
    EXPECT_LT((with.compliance.topLeftCorner<3, 3>() - measured).norm(), 1e-6 * scale) << seed;
    EXPECT_GT((without.compliance.topLeftCorner<3, 3>() - measured).norm(), 1e-4 * scale) << seed;
    const Eigen::Matrix3d plain = without.compliance.topLeftCorner<3, 3>();
    EXPECT_NEAR(robot::geometricStiffnessShare(with, without), (plain - measured).norm() / plain.norm(), 1e-5);
  }
}

TEST(CartesianStiffness, IsReciprocalAndInvertsToPaper4) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const LoadedExample arm(seed);
    const robot::ArmPosture posture = arm.rest(arm.load);
    const Eigen::Vector3d point = robot::flangeAt(arm.geometry.arm, posture) * arm.tcp;
    const robot::Wrench wrench{robot::flangeAt(arm.geometry.arm, posture) * arm.load.point_in_flange, arm.load.force,
                               Eigen::Vector3d::Zero()};
    const Jacobian jacobian = robot::jacobianAt(arm.geometry.arm, posture, point);
    const robot::CartesianStiffness found = robot::cartesianStiffness(
        point, jacobian, arm.c, robot::geometricStiffness(robot::axesAt(arm.geometry.arm, posture), wrench));
    ASSERT_TRUE(found.invertible);
    const Matrix6d &k = found.stiffness, &compliance = found.compliance;
    // A force at one place and a moment at another do the same work each on the other's displacement (Betti).
    EXPECT_LT((compliance - compliance.transpose()).norm(), 1e-12 * compliance.norm());
    EXPECT_LT((k - k.transpose()).norm(), 1e-12 * k.norm());
    EXPECT_LT((k * compliance - Matrix6d::Identity()).norm(),
              1e-8);  // rounding times a condition number of 1e5
    for (const robot::PrincipalStiffness& one : found.principal) {
      const Eigen::Vector3d moved = compliance.topLeftCorner<3, 3>() * one.direction;
      EXPECT_LT((moved - one.direction / one.stiffness).norm(), 1e-12 * moved.norm());
    }
    EXPECT_GE(found.anisotropy(), 1.0);
  }
}

/// Springs of the size that the arm needs: a few tenths of a milliradian under the loads below.
JointVector springsOf(const ChainArm& chain) { return JointVector::LinSpaced(chain.joints(), 1e-6, 5e-6); }

TEST(CartesianStiffness, OfMoreThanSixJointsIsTheInverseOfTheirCompliance) {
  for (const ChainArm& chain : {sevenAxisChain(), eightAxisChain()}) {
    const robot::Robot arm = chain.robot();
    const JointVector compliance = springsOf(chain);
    Noise noise(2);
    for (int k = 0; k < 20; ++k) {
      const JointVector q = somePosture(noise, chain);
      const Eigen::Vector3d point = chain.flangeAt(q) * Eigen::Vector3d(0.0, 0.0, 0.1);
      const Jacobian jacobian = robot::jacobianAt(arm, robot::postureAt(arm, q), point);
      const robot::CartesianStiffness found = robot::cartesianStiffness(point, jacobian, compliance);
      Matrix6d expected = Matrix6d::Zero();  // J K^-1 J^T, a spring at a time
      for (int j = 0; j < chain.joints(); ++j)
        expected += compliance[j] * jacobian.col(j) * jacobian.col(j).transpose();
      EXPECT_LT((found.compliance - expected).norm(), 1e-14 * expected.norm()) << chain.joints();
      ASSERT_TRUE(found.invertible) << chain.joints();
      const Matrix6d inverse = expected.inverse();
      // Rounding times a condition number of some thousands.
      EXPECT_LT((found.stiffness - inverse).norm(), 1e-10 * inverse.norm()) << chain.joints();
      EXPECT_LT((found.stiffness * found.compliance - Matrix6d::Identity()).norm(), 1e-10) << chain.joints();

      // A rigid joint less, six springs are left or seven; then fewer than the directions of the flange.
      JointVector stiffer = compliance;
      stiffer[2] = 0.0;
      EXPECT_TRUE(robot::cartesianStiffness(point, jacobian, stiffer).invertible) << chain.joints();
      for (int j = 3; j < chain.joints() - 3; ++j) stiffer[j] = 0.0;
      const robot::CartesianStiffness locked = robot::cartesianStiffness(point, jacobian, stiffer);
      EXPECT_FALSE(locked.invertible) << chain.joints();
      EXPECT_TRUE(locked.stiffness.isZero());
    }
  }
}

TEST(CartesianStiffness, OfFiveJointsIsNotInvertible) {
  const ChainArm chain = fiveAxisChain();
  Noise noise(3);
  const JointVector q = somePosture(noise, chain);
  const Eigen::Vector3d point = chain.flangeAt(q).translation();
  const Jacobian jacobian = robot::jacobianAt(chain.robot(), robot::postureAt(chain.robot(), q), point);
  const robot::CartesianStiffness found = robot::cartesianStiffness(point, jacobian, springsOf(chain));
  EXPECT_FALSE(found.invertible);
  EXPECT_TRUE(found.stiffness.isZero());
  for (const robot::PrincipalStiffness& one : found.principal) EXPECT_TRUE(std::isfinite(one.stiffness));
  EXPECT_GE(found.anisotropy(), 1.0);
}

/// Where the flange's point comes to rest under a dead force there, springs and load on the moved arm.
JointVector settled(const ChainArm& chain, const JointVector& q, const Eigen::Vector3d& in_flange,
                    const Eigen::Vector3d& force) {
  JointVector at = q;
  for (int i = 0; i < 40; ++i) {  // contracts a thousandfold a turn
    at = q + springsOf(chain).cwiseProduct(
                 chain.torqueOf(at, chain.joints(), chain.flangeAt(at) * in_flange, force, Eigen::Vector3d::Zero()));
  }
  return at;
}

TEST(CartesianStiffness, WithKcIsTheDerivativeOfTheEquilibriumOfAnyNumberOfJoints) {
  const Eigen::Vector3d hook(0.05, -0.1, 0.2), force(100.0, -150.0, -300.0);
  for (const ChainArm& chain : {fiveAxisChain(), sevenAxisChain(), eightAxisChain()}) {
    const robot::Robot arm = chain.robot();
    Noise noise(4);
    for (int k = 0; k < 5; ++k) {
      const JointVector q = somePosture(noise, chain), rest = settled(chain, q, hook, force);
      const robot::ArmPosture posture = robot::postureAt(arm, rest);
      const Eigen::Vector3d point = chain.flangeAt(rest) * hook;
      const JointMatrix kc =
          robot::geometricStiffness(robot::axesAt(arm, posture), {point, force, Eigen::Vector3d::Zero()});
      const robot::CartesianStiffness with =
          robot::cartesianStiffness(point, robot::jacobianAt(arm, posture, point), springsOf(chain), kc);
      Eigen::Matrix3d measured;
      constexpr double kStep = 3.0;  // N
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
        measured.col(axis) = (chain.flangeAt(settled(chain, q, hook, force + step)) * hook -
                              chain.flangeAt(settled(chain, q, hook, force - step)) * hook) /
                             (2.0 * kStep);
      }
      // A hundredth of the load's own second order, squared, and rounding of 1e-16 m against moves of 1e-5 m.
      EXPECT_LT((with.compliance.topLeftCorner<3, 3>() - measured).norm(), 1e-7 * measured.norm()) << chain.joints();
    }
  }
}

TEST(PostureConditioning, ByHandAndInASingularity) {
  // Singular values 2 (three times, lengths over L = 0.5 m) and 1 (three times): kappa is
  // 1/6 sqrt(3 * 4 + 3) sqrt(3 / 4 + 3) = 1.25.
  const identification::PostureConditioning found = identification::postureConditioning(Jacobian::Identity(6, 6), 0.5);
  EXPECT_NEAR(found.kappa, 1.25, 1e-14);
  EXPECT_NEAR(found.kappa_two, 2.0, 1e-14);
  EXPECT_NEAR(found.dexterity, 0.8, 1e-14);
  EXPECT_NEAR(identification::postureConditioning(Jacobian::Identity(6, 6), 1.0).kappa, 1.0, 1e-14);
  // Axis 5 at zero puts axes 4 and 6 in one line.
  const robot::Robot arm = exampleChain().robot();
  const robot::ArmPosture straight = robot::postureAt(arm, degrees(10, 20, -10, 30, 0, 40));
  const identification::PostureConditioning singular = identification::postureConditioning(
      robot::jacobianAt(arm, straight, robot::flangeAt(arm, straight).translation()), 0.5);
  EXPECT_TRUE(std::isinf(singular.kappa));
  EXPECT_EQ(singular.dexterity, 0.0);
}

/// By central differences of the flange's pose: rows 0-2 its origin, rows 3-5 its turn.
Jacobian differencedJacobian(const robot::Robot& arm, const JointVector& q) {
  constexpr double kStep = 1e-5;
  Jacobian jacobian(6, arm.joints());
  for (int j = 0; j < arm.joints(); ++j) {
    const JointVector step = kStep * JointVector::Unit(arm.joints(), j);
    const Eigen::Isometry3d ahead = robot::flangeAt(arm, robot::postureAt(arm, q + step)),
                            behind = robot::flangeAt(arm, robot::postureAt(arm, q - step));
    const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
    jacobian.col(j) << ahead.translation() - behind.translation(), turn.angle() * turn.axis();
  }
  return jacobian / (2.0 * kStep);
}

TEST(PostureStiffness, IsOfTheMethodsOwnGeometryWherePosturesWereMadeInAnother) {
  const LinearMachine machine(4, 1.0);
  identification::Identification result;
  result.cases = machine.cases;
  result.characteristic_length.length = 0.7;
  result.characteristic_length.condition = 1.0;
  identification::MethodResult& method = result.methods[static_cast<std::size_t>(identification::Method::partial_pose)];
  method.available = true;
  method.estimate = identification::StiffnessEstimate(6);
  method.estimate.compliance = machine.compliance;
  method.geometry = machine.geometry;
  metrology::Line& axis = method.geometry.arm.axes_in_base_at_zero[2];  // a calibration that finds much
  axis.point.x() += 0.05;
  axis.direction = (axis.direction + 0.05 * Eigen::Vector3d::UnitZ()).normalized();
  campaign::Campaign campaign;
  campaign.pose_ids = {"1", "2", "3", "4"};
  const identification::PostureStiffnesses found(campaign, result, identification::Method::partial_pose);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Jacobian jacobian = differencedJacobian(method.geometry.arm, result.cases[i].q_sagged);
    // Differences are good to the square of the step; the shift alone changes kappa by a hundredth.
    EXPECT_NEAR(found.at(i).conditioning.kappa, identification::postureConditioning(jacobian, 0.7).kappa, 1e-6) << i;
  }
}

TEST(PostureStiffness, OfACampaignNamesPosturesAndRigidJoints) {
  SimulatedLab lab;
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addWristSweep(campaign);
  lab.addLoading(campaign, 8, hangingForce);
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = 5;
  const identification::Identification result = identification::identify(campaign, options);
  const identification::PostureStiffnesses found(campaign, result, identification::Method::partial_pose);
  ASSERT_EQ(found.size(), 8u);
  EXPECT_EQ(found.at(2).pose, "3");
  EXPECT_EQ(found.at(2).rigid_joints, std::vector<int>{0});  // a hanging load never turns axis 1
  EXPECT_GT(found.at(2).kc_share, 1e-4);
  EXPECT_LT(found.at(2).kc_share, 0.1);
  EXPECT_GT(found.at(2).conditioning.kappa, 1.0);
  EXPECT_FALSE(found.at(2).with_kc.invertible);
  EXPECT_GT(found.at(2).with_kc.principal[1].stiffness, found.at(2).with_kc.principal[0].stiffness);
}

}  // namespace cartesian_stiffness_test
}  // namespace stiffscope
