#include "core/comparison/change_causes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "tests/fixtures/chain_arm.h"

// Changes that the tests' own arm makes, with nothing else in them.

namespace stiffscope {
namespace change_causes_test {

using comparison::CauseEvidence;
using comparison::ChangeCause;

constexpr double kSd = 1e-5;  // of each number, rad or m
constexpr double kPostures = 60.0;

struct Machine {
  ChainArm chain = exampleChain();
  robot::Robot arm;
  comparison::GeometryNumbers numbers;
  std::vector<Eigen::Index> seen;

  Machine() : arm(chain.robot()), numbers(arm), seen(static_cast<std::size_t>(numbers.count())) {
    std::iota(seen.begin(), seen.end(), 0);
  }

  Eigen::VectorXd changeTo(const ChainArm& other) const {
    return numbers.difference(numbers.of(arm), numbers.of(other.robot()));
  }
  std::vector<CauseEvidence> causesOf(const Eigen::VectorXd& change) const {
    const Eigen::Index count = change.size();
    const Eigen::MatrixXd covariance = kSd * kSd * Eigen::MatrixXd::Identity(count, count);
    return comparison::causesOfMachine(numbers, arm, seen, {change, covariance, 100.0, kPostures},
                                       Eigen::MatrixXd::Identity(count, count));
  }
};

TEST(CausesOfMachine, AJointsZeroIsOneUnknown) {
  const Machine machine;
  for (const std::size_t joint : {1u, 2u, 3u, 4u}) {
    ChainArm moved = machine.chain;
    moved.to_joint[joint].rotate(Eigen::AngleAxisd(3e-4, moved.axis[joint]));
    const Eigen::VectorXd change = machine.changeTo(moved);
    const CauseEvidence best = machine.causesOf(change).front();
    EXPECT_EQ(best.cause, ChangeCause::joint_zero) << joint;
    EXPECT_EQ(best.axis, static_cast<int>(joint) + 1);
    ASSERT_TRUE(best.size) << joint;
    EXPECT_NEAR(std::abs(best.size->value), 3e-4, 1e-8);
    EXPECT_NEAR(best.size->sd, kSd, 1e-9);
    EXPECT_NEAR(best.chi2, 900.0, 0.1);  // (3e-4 / 1e-5)^2
    // One unknown at the price of ln(60), nothing left.
    EXPECT_NEAR(best.bic, std::log(kPostures), 1e-2);
    EXPECT_NEAR(best.at_targets, 3e-4, 1e-8);  // `moves` is the identity here
  }
}

TEST(CausesOfMachine, AllLengthsGrowByAFactor) {
  const Machine machine;
  ChainArm grown = machine.chain;
  for (Eigen::Isometry3d& one : grown.to_joint) one.translation() *= 1.0 + 2e-4;
  const CauseEvidence best = machine.causesOf(machine.changeTo(grown)).front();
  EXPECT_EQ(best.cause, ChangeCause::growth);
  ASSERT_TRUE(best.size);
  EXPECT_NEAR(best.size->value, 2e-4, 1e-8);
}

// A link bent in every direction at once. It changes the axes' relation at that link alone, which neither a zero nor
// the axis by itself does: with them more than chance is left.
TEST(CausesOfMachine, ABentLinkIsTheOneBetweenItsAxes) {
  const Machine machine;
  ChainArm bent = machine.chain;
  bent.to_joint[3].translate(Eigen::Vector3d(2e-4, -3e-4, 2.5e-4));
  bent.to_joint[3].rotate(Eigen::AngleAxisd(4e-4, Eigen::Vector3d(0.5, 0.7, -0.5).normalized()));
  const std::vector<CauseEvidence> causes = machine.causesOf(machine.changeTo(bent));
  EXPECT_EQ(causes.front().cause, ChangeCause::link);
  EXPECT_EQ(causes.front().axis, 3);
  EXPECT_GT(causes.front().left_p, 0.99);
  EXPECT_FALSE(causes.front().size);
  EXPECT_LT(causes[1].left_p, 1e-3);
  for (std::size_t i = 1; i < causes.size(); ++i) EXPECT_LE(causes[i - 1].bic, causes[i].bic);
}

TEST(CausesOfReflectors, ATurnOfAllIsToldFromOneThatMoved) {
  // Three reflectors; what a turn about axis 6 does to them, m/rad.
  const Eigen::VectorXd by_turn = (Eigen::VectorXd(9) << 0.1, 0.2, 0, -0.3, 0.1, 0, 0.2, -0.2, 0).finished();
  const Eigen::MatrixXd covariance = kSd * kSd * Eigen::MatrixXd::Identity(9, 9);
  const std::vector<CauseEvidence> turned = comparison::causesOfReflectors(
      by_turn, Machine().arm.axes_in_base_at_zero, {1e-3 * by_turn, covariance, 100.0, kPostures});
  EXPECT_EQ(turned.front().cause, ChangeCause::turn_about_last);
  ASSERT_TRUE(turned.front().size);
  EXPECT_NEAR(turned.front().size->value, 1e-3, 1e-12);
  EXPECT_NEAR(turned.front().size->sd, kSd / by_turn.norm(), 1e-12);
  // Both explain all; nine unknowns cost nine times as much as one.
  EXPECT_NEAR(turned[1].bic - turned[0].bic, 8.0 * std::log(kPostures), 1e-6);
  Eigen::VectorXd one_moved = Eigen::VectorXd::Zero(9);
  one_moved.segment<3>(3) << 1e-4, 2e-4, -1e-4;
  EXPECT_EQ(comparison::causesOfReflectors(by_turn, Machine().arm.axes_in_base_at_zero,
                                           {one_moved, covariance, 100.0, kPostures})
                .front()
                .cause,
            ChangeCause::reflectors);
}

}  // namespace change_causes_test
}  // namespace stiffscope
