#include "core/interchange/state_join.h"

#include <gtest/gtest.h>

#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace chord_check_test {

using namespace interchange;
using Convention = std::vector<campaign::JointReading>;

/// Readings of two reflectors at postures of the chain arm, by its own kinematics; the controller's figures as
/// `figuresOf` turns the angles.
template <class Figures>
std::vector<PlacedReading> readingsWith(const Figures& figuresOf, double scale = 1.0, int postures = 20) {
  const ChainArm arm = exampleChain();
  const Eigen::Isometry3d tracker_from_base = Eigen::Translation3d(3.0, -1.0, 0.5) *
                                              Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                              Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  Noise noise(4);
  std::vector<PlacedReading> readings;
  for (int i = 0; i < postures; ++i) {
    const JointVector q = somePosture(noise);
    int target = 0;
    for (const Eigen::Vector3d& on_flange : {Eigen::Vector3d(0.26, 0.03, 0.06), Eigen::Vector3d(-0.16, 0.21, 0.1)})
      readings.push_back({figuresOf(q), target++, scale * (tracker_from_base * (arm.flangeAt(q) * on_flange))});
  }
  return readings;
}

const auto kAsTheyAre = [](const JointVector& q) { return q; };

TEST(ChordCheck, DistancesOfTheNominalArmAgreeInAnyFrame) {
  const auto misfit = chordMisfit(exampleChain().robot(), {}, readingsWith(kAsTheyAre));
  ASSERT_TRUE(misfit);
  EXPECT_LT(*misfit, 1e-7);  // the fit of a reflector's place stops there
}

TEST(ChordCheck, FewPosturesSayNothing) {
  EXPECT_FALSE(chordMisfit(exampleChain().robot(), {}, readingsWith(kAsTheyAre, 1.0, 5)));
  EXPECT_TRUE(otherMeanings(exampleChain().robot(), {}, readingsWith(kAsTheyAre, 1.0, 5)).empty());
}

TEST(ChordCheck, NamesACouplingThatWasNotStated) {
  const auto against_horizontal = [](const JointVector& q) {
    JointVector figures = q;
    figures[2] -= q[1];
    return figures;
  };
  const auto readings = readingsWith(against_horizontal);
  const robot::Robot robot = exampleChain().robot();
  EXPECT_GT(*chordMisfit(robot, {}, readings), 0.05);
  EXPECT_LT(*chordMisfit(robot, Convention{{2, 1.0, 0.0, 1}}, readings), 1e-7);
  const auto others = otherMeanings(robot, {}, readings);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].kind, OtherMeaning::Kind::coupling);
  EXPECT_EQ(others[0].joint, 2);
  EXPECT_EQ(others[0].plus, 1);
  EXPECT_LT(others[0].misfit, 1e-7);
}

TEST(ChordCheck, NamesACouplingThatWasStatedAndIsNone) {
  const auto others = otherMeanings(exampleChain().robot(), Convention{{2, 1.0, 0.0, 1}}, readingsWith(kAsTheyAre));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].kind, OtherMeaning::Kind::coupling);
  EXPECT_EQ(others[0].joint, 2);
  EXPECT_EQ(others[0].plus, -1);
}

TEST(ChordCheck, NamesSignsAndQuarterTurns) {
  for (const int joint : {1, 2, 3, 4}) {
    const auto turned = [joint](const JointVector& q) {
      JointVector figures = q;
      figures[joint] = -q[joint];
      return figures;
    };
    const auto others = otherMeanings(exampleChain().robot(), {}, readingsWith(turned));
    const bool named = std::any_of(others.begin(), others.end(), [joint](const OtherMeaning& other) {
      return other.kind == OtherMeaning::Kind::sign && other.joint == joint && other.value == -1.0;
    });
    EXPECT_TRUE(named) << joint;
    // A spherical wrist turned by half a turn in joint 4 is one with the other sign of joint 5.
    EXPECT_EQ(others.size(), joint == 4 ? 2u : 1u) << joint;
  }
  const auto from_upright = [](const JointVector& q) {
    JointVector figures = q;
    figures[1] -= std::acos(0.0);
    return figures;
  };
  const auto others = otherMeanings(exampleChain().robot(), {}, readingsWith(from_upright));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].kind, OtherMeaning::Kind::offset);
  EXPECT_EQ(others[0].joint, 1);
  EXPECT_DOUBLE_EQ(others[0].value, std::acos(0.0));
}

TEST(ChordCheck, NamesInchesReadAsMillimetres) {
  const auto others = otherMeanings(exampleChain().robot(), {}, readingsWith(kAsTheyAre, 1.0 / 25.4));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].kind, OtherMeaning::Kind::unit);
  EXPECT_DOUBLE_EQ(others[0].value, 25.4);
}

}  // namespace chord_check_test
}  // namespace stiffscope
