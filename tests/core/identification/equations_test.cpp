#include <gtest/gtest.h>
#include "core/identification/remarks.h"
#include "core/robot/wrench.h"
#include "metrology/trilateration.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace equations_test {

// A tenth of a newton: joints turn by 1e-7 rad, whose second order, and rounding of 1e-16 m in displacements
// of 1e-8 m (3 m places: 5e-16), leave about 1e-6 of a compliance; ill-conditioned postures multiply that by
// some tens.
constexpr double kLinear = 1e-5;
constexpr int kPostures = 8;

TEST(LinearMachine, TorqueIsTheTestsOwn) {
  const LinearMachine machine(kPostures, 1.0);
  const auto torques = machine.torques();
  for (std::size_t i = 0; i < machine.cases.size(); ++i) {
    const robot::Wrench& wrench = machine.cases[i].wrench;
    const JointVector own = machine.chain.torqueOf(machine.cases[i].q, 6, wrench.point, wrench.force, wrench.moment);
    EXPECT_LT((torques[i] - own).norm(), 1e-10 * own.norm());  // rounding of sums of 1e4 Nm
    const Eigen::Vector3d wrist =
        identification::modelledWrist(machine.geometry.arm, machine.cases[i], machine.wrist_at_zero);
    for (const Eigen::Vector3d& elsewhere : {wrist, Eigen::Vector3d(5, -7, 9)}) {
      const JointVector there = robot::jointTorque(machine.cases[i].axes, wrench.about(elsewhere));
      EXPECT_LT((there - own).norm(), 1e-10 * own.norm());
    }
  }
}

TEST(CompletePose, GivesTheSpringsBackAtAnyCharacteristicLength) {
  const LinearMachine machine(kPostures);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, -0.2, 0.5)}) {
    const auto equations = machine.poseEquations(point);
    for (const double length : {0.05, 0.35, 1.0, 4.0, 20.0}) {
      const identification::StiffnessEstimate found = identification::completePose(equations, length, kAllJoints);
      EXPECT_LT(worstError(found.compliance, machine.compliance), kLinear) << length;
      EXPECT_TRUE(found.mark(4).empty());
    }
  }
}

TEST(CompletePose, OnlyTheDisplacementRowsAreDividedByTheLength) {
  identification::CaseEquations pose{Eigen::Matrix<double, 6, 6>::Ones(), Eigen::VectorXd::Constant(6, 8.0)};
  const identification::CaseEquations scaled = identification::normalised(pose, 4.0);
  EXPECT_EQ(scaled.right, (Eigen::VectorXd(6) << 2, 2, 2, 8, 8, 8).finished());
  EXPECT_EQ(scaled.matrix(2, 3), 0.25);
  EXPECT_EQ(scaled.matrix(3, 2), 1.0);
}

TEST(PartialPose, GivesTheSpringsBack) {
  const LinearMachine machine(kPostures);
  EXPECT_LT(
      worstError(identification::partialPose(machine.reflectorEquations(), kAllJoints).compliance, machine.compliance),
      kLinear);
}

TEST(DecoupledPartialPose, GivesTheSpringsBack) {
  const LinearMachine machine(kPostures);
  const identification::StiffnessEstimate found =
      identification::decoupledPartialPose(machine.wristEquationsOfAll(), machine.reflectorEquations(), kAllJoints);
  EXPECT_LT(worstError(found.compliance, machine.compliance), kLinear);
}

/// Machines of five, seven and eight joints.
std::vector<LinearMachine> machinesOfOtherSizes() {
  std::vector<LinearMachine> machines;
  for (const ChainArm& chain : {fiveAxisChain(), sevenAxisChain(), eightAxisChain()})
    machines.emplace_back(kPostures, 1e-4, 3, chain);
  return machines;
}

TEST(OtherNumbersOfJoints, TorquesAreTheTestsOwn) {
  for (const LinearMachine& machine : machinesOfOtherSizes()) {
    const auto torques = machine.torques();
    for (std::size_t i = 0; i < machine.cases.size(); ++i) {
      const robot::Wrench& wrench = machine.cases[i].wrench;
      const JointVector own =
          machine.chain.torqueOf(machine.cases[i].q, machine.chain.joints(), wrench.point, wrench.force, wrench.moment);
      ASSERT_EQ(torques[i].size(), machine.chain.joints());
      EXPECT_LT((torques[i] - own).norm(), 1e-10 * own.norm());  // rounding
    }
  }
}

TEST(OtherNumbersOfJoints, EveryMethodGivesTheSpringsBack) {
  for (const LinearMachine& machine : machinesOfOtherSizes()) {
    SCOPED_TRACE(machine.chain.joints());
    const robot::JointMask all = machine.allJoints();
    const auto expectTheSprings = [&](const identification::StiffnessEstimate& found) {
      ASSERT_EQ(found.joints(), machine.chain.joints());
      EXPECT_LT(worstError(found.compliance, machine.compliance, all), kLinear);
      EXPECT_TRUE(found.mark(machine.chain.joints() - 1).empty());
    };
    expectTheSprings(identification::partialPose(machine.reflectorEquations(), all));
    expectTheSprings(
        identification::decoupledPartialPose(machine.wristEquationsOfAll(), machine.reflectorEquations(), all));
    expectTheSprings(identification::completePose(machine.poseEquations(), 0.5, all));
  }
}

TEST(OtherNumbersOfJoints, TheWristsOwnJointsDoNotMoveItsCentre) {
  for (const LinearMachine& machine : machinesOfOtherSizes()) {
    for (const identification::CaseEquations& one : machine.wristEquationsOfAll()) {
      const int wrist = robot::wristJointsOf(machine.chain.joints());
      // The centre is found from the reflectors to 1e-10 m.
      EXPECT_LT(one.matrix.rightCols(wrist).norm(), 1e-9 * one.matrix.norm()) << machine.chain.joints();
      EXPECT_GT(one.matrix.leftCols(robot::armJointsOf(machine.chain.joints())).colwise().norm().minCoeff(), 0.0);
    }
  }
}

TEST(FullLoad, WithoutTheMiddleOfTheDisplacementTheSecondOrderShows) {
  // 1.5 kN: turns of 1e-3 rad. Jacobians unloaded leave their half; at the middle of the displacement its
  // square.
  LinearMachine machine(kPostures, 1.0);
  const double unloaded =
      worstError(identification::partialPose(machine.reflectorEquations(), kAllJoints).compliance, machine.compliance);
  identification::takeJacobiansAtMiddle(machine.geometry, machine.compliance, machine.torques(), machine.cases);
  const double middle =
      worstError(identification::partialPose(machine.reflectorEquations(), kAllJoints).compliance, machine.compliance);
  EXPECT_GT(unloaded, 1e-4);
  EXPECT_LT(middle, 1e-4);
}

/// Stacks equations and solves for the joints from `first` to `last` by QR, the right side less A c of the
/// others.
Eigen::VectorXd byHand(const std::vector<identification::CaseEquations>& equations, int first, int count,
                       const JointVector& others) {
  Eigen::Index rows = 0;
  for (const identification::CaseEquations& one : equations) rows += one.right.size();
  Eigen::MatrixXd matrix(rows, 6);
  Eigen::VectorXd right(rows);
  rows = 0;
  for (const identification::CaseEquations& one : equations) {
    matrix.middleRows(rows, one.right.size()) = one.matrix;
    right.segment(rows, one.right.size()) = one.right;
    rows += one.right.size();
  }
  right -= matrix * others;
  // Columns of 1e-3 and 1e-1 m are scaled by QR's own pivoting well enough.
  return matrix.middleCols(first, count).colPivHouseholderQr().solve(right);
}

/// The machine with tracker noise in its readings.
LinearMachine noisyMachine(int postures, std::uint64_t seed) {
  LinearMachine machine(postures, 1.0, seed);
  Noise noise(seed + 100);
  for (identification::LoadCase& one : machine.cases) {
    for (identification::TargetMove& move : one.targets)
      move.loaded += 2e-5 * noise.normal3(), move.unloaded += 2e-5 * noise.normal3();
  }
  return machine;
}

TEST(DecoupledPartialPose, IsTwoLeastSquaresOneAfterTheOther) {
  const LinearMachine machine = noisyMachine(kPostures, 7);
  const auto wrist = machine.wristEquationsOfAll(), reflectors = machine.reflectorEquations();
  JointVector arm = JointVector::Zero(6);
  arm.head<3>() = byHand(wrist, 0, 3, JointVector::Zero(6));
  const Eigen::VectorXd wrist_joints = byHand(reflectors, 3, 3, arm);
  const identification::StiffnessEstimate found = identification::decoupledPartialPose(wrist, reflectors, kAllJoints);
  // Normal equations against QR: 1e-16 times the condition (tens) squared.
  EXPECT_LT((found.compliance.head<3>() - arm.head<3>()).norm(), 1e-11 * arm.norm());
  EXPECT_LT((found.compliance.tail<3>() - wrist_joints).norm(), 1e-11 * wrist_joints.norm());
}

TEST(PartialPose, IsTheLeastSquaresOfTheStackedRows) {
  const LinearMachine machine = noisyMachine(kPostures, 8);
  const auto reflectors = machine.reflectorEquations();
  const Eigen::VectorXd by_hand = byHand(reflectors, 0, 6, JointVector::Zero(6));
  const identification::StiffnessEstimate found = identification::partialPose(reflectors, kAllJoints);
  EXPECT_LT((found.compliance - by_hand).norm(), 1e-10 * by_hand.norm());
  double sum = 0.0;
  for (const identification::CaseEquations& one : reflectors) sum += (one.right - one.matrix * by_hand).squaredNorm();
  EXPECT_NEAR(found.sigma, std::sqrt(sum / (9.0 * kPostures - 6.0)), 1e-12);
  EXPECT_NEAR(found.rms_residual, std::sqrt(sum / (9.0 * kPostures)), 1e-12);
}

TEST(MaskedJoint, IsLeftOutAndZero) {
  const LinearMachine machine(kPostures);
  const robot::JointMask without_first{false, true, true, true, true, true};
  const identification::StiffnessEstimate found =
      identification::partialPose(machine.reflectorEquations(), without_first);
  EXPECT_EQ(found.compliance[0], 0.0);
  EXPECT_EQ(found.covariance(0, 0), 0.0);
}

// Coverage of the stated standard uncertainties: many machines, same springs, other noise; the truth must lie
// within 1.96 of them in about 95 %. Scatter between n postures estimates a covariance no better than n
// degrees of freedom do.

std::array<double, 6> coverage(int postures, bool decoupled) {
  constexpr int kMachines = 500;
  std::array<double, 6> inside{};
  LinearMachine clean(postures, 1.0, 41);
  identification::takeJacobiansAtMiddle(clean.geometry, clean.compliance, clean.torques(), clean.cases);
  Noise noise(17);
  for (int k = 0; k < kMachines; ++k) {
    LinearMachine machine = clean;
    for (identification::LoadCase& one : machine.cases) {
      for (identification::TargetMove& move : one.targets) {
        move.loaded += 2e-5 * noise.normal3();
        move.unloaded += 2e-5 * noise.normal3();
      }
    }
    const identification::StiffnessEstimate found =
        decoupled ? identification::decoupledPartialPose(machine.wristEquationsOfAll(), machine.reflectorEquations(),
                                                         kAllJoints)
                  : identification::partialPose(machine.reflectorEquations(), kAllJoints);
    for (int j = 0; j < 6; ++j) {
      const double sd = std::sqrt(found.covariance(j, j));
      inside[static_cast<std::size_t>(j)] += std::abs(found.compliance[j] - machine.compliance[j]) < 1.96 * sd;
    }
  }
  for (double& one : inside) one /= kMachines;
  return inside;
}

TEST(StatedUncertainty, CoversTheTruthWithManyPostures) {
  for (const bool decoupled : {false, true}) {
    const auto inside = coverage(60, decoupled);
    // 500 machines: 1 % standard error; a sandwich on 60 postures is known to be some per cent short.
    for (const double one : inside) {
      EXPECT_GT(one, 0.90);
      EXPECT_LT(one, 0.99);
    }
  }
}

TEST(StatedUncertainty, CoversTheTruthWithNineteenPostures) {
  for (const bool decoupled : {false, true}) {
    const auto inside = coverage(19, decoupled);
    for (const double one : inside) {
      EXPECT_GT(one, 0.89);  // 1.96 sd where 19 postures ask for Student's quantile of about 2.2
      EXPECT_LT(one, 0.99);
    }
  }
}

TEST(Mark, NegativeAndImprecise) {
  identification::StiffnessEstimate estimate(6);
  estimate.compliance << 1e-6, -1e-6, 1e-6, 1e-6, 1e-6, 1e-6;
  estimate.covariance.diagonal() << 1e-14, 1e-14, 4e-12, 1e-14, 1e-14, 1e-14;
  EXPECT_TRUE(estimate.mark(0).empty());
  EXPECT_TRUE(estimate.mark(1).is(identification::RemarkId::negative));
  EXPECT_TRUE(estimate.mark(2).is(identification::RemarkId::imprecise));  // sd(c) = 2 c
  EXPECT_NEAR(estimate.stiffnessSd(0), 1e-7 / 1e-12, 1.0);

  // With intervals of their own these decide, whatever the standard deviation: 2 c of joint 3 is in long tails.
  estimate.stated.assign(6, {0.8e-6, 1.2e-6});
  estimate.stated[1] = {-1.2e-6, -0.8e-6};
  estimate.stated[3] = {-0.1e-6, 2.1e-6};  // open above
  estimate.stated[4] = {0.3e-6, 1.7e-6};   // k up to 3.3 of 1
  EXPECT_TRUE(estimate.mark(1).is(identification::RemarkId::negative));
  EXPECT_TRUE(estimate.mark(2).empty());
  EXPECT_TRUE(estimate.mark(3).is(identification::RemarkId::imprecise));
  EXPECT_TRUE(estimate.mark(4).is(identification::RemarkId::imprecise));
  EXPECT_TRUE(estimate.mark(5).empty());
}

TEST(WristMove, TakesTheLargestTriangleAndTheRootByTheArm) {
  LinearMachine machine(3, 1.0);
  // A fourth reflector close to the first: the triangle with it is thin. Its reading is spoilt: it must not
  // be used.
  machine.geometry.targets_at_zero.push_back(*machine.geometry.targets_at_zero[0] + Eigen::Vector3d(0.001, 0, 0));
  machine.radii.push_back((*machine.geometry.targets_at_zero[3] - machine.wrist_at_zero).norm());
  for (identification::LoadCase& one : machine.cases) {
    one.targets.push_back(one.targets[0]);
    one.targets.back().target = 3;
    one.targets.back().loaded += Eigen::Vector3d(0.1, 0.1, 0.1);
    const Eigen::Vector3d modelled = identification::modelledWrist(machine.geometry.arm, one, machine.wrist_at_zero);
    const auto move = identification::wristMove(one, machine.radii, modelled);
    ASSERT_TRUE(move);
    const Eigen::Vector3d centre = machine.chain.framesAt(one.q)[4].translation();
    EXPECT_LT((move->unloaded - centre).norm(), 1e-10);
    EXPECT_LT((move->displacement()).norm(), 0.02);  // not the mirror root, decimetres away
    // Radius unknown for one of three: none.
    identification::LoadCase two = one;
    two.targets.resize(3);
    std::vector<double> radii = machine.radii;
    radii[1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(identification::wristMove(two, radii, modelled));
    // The third nearly on the line of the other two, by a five hundredth of their distance: the noise of a reading
    // would move the centre on a circle about that line.
    two.targets[1] = one.targets[1];
    const auto between = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d {
      return 0.4 * a + 0.6 * b + 0.002 * (b - a).norm() * (b - a).unitOrthogonal();
    };
    two.targets[2].unloaded = between(two.targets[0].unloaded, two.targets[1].unloaded);
    two.targets[2].loaded = between(two.targets[0].loaded, two.targets[1].loaded);
    radii = machine.radii;
    radii[2] = (two.targets[2].unloaded - centre).norm();
    EXPECT_FALSE(identification::wristMove(two, radii, modelled));
  }
}

TEST(CharacteristicLength, IsWhereTheStackedJacobianIsBestConditioned) {
  const LinearMachine machine(kPostures);
  const identification::CharacteristicLength found = identification::characteristicLength(machine.cases, {0, 0, 0});
  const auto condition = [&](double length) {
    Eigen::MatrixXd stacked(6 * kPostures, 6);
    for (int i = 0; i < kPostures; ++i) {
      const identification::LoadCase& one = machine.cases[static_cast<std::size_t>(i)];
      const auto frames = machine.chain.framesAt(one.q);
      for (std::size_t j = 0; j < 6; ++j) {
        const Eigen::Vector3d axis = frames[j].linear() * machine.chain.axis[j];
        stacked.block<3, 1>(6 * i, static_cast<int>(j)) =
            axis.cross(frames[6].translation() - frames[j].translation()) / length;
        stacked.block<3, 1>(6 * i + 3, static_cast<int>(j)) = axis;
      }
    }
    const Eigen::VectorXd values = stacked.jacobiSvd().singularValues();
    return values[0] / values[5];
  };
  EXPECT_NEAR(found.condition, condition(found.length), 1e-8 * found.condition);
  for (const double factor : {0.2, 0.8, 0.99, 1.01, 1.25, 5.0})
    EXPECT_GT(condition(factor * found.length), found.condition);
}

}  // namespace equations_test
}  // namespace stiffscope
