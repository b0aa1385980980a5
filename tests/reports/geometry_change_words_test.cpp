#include "reports/words/geometry_change_words.h"

#include <gtest/gtest.h>

#include <string>

namespace stiffscope {
namespace geometry_change_words_test {

using comparison::CauseEvidence;
using comparison::ChangeCause;
using comparison::NumberKind;

CauseEvidence causeOf(ChangeCause cause, int axis, int joint) {
  CauseEvidence evidence{.cause = cause, .axis = axis, .joint = joint};
  evidence.size = comparison::Uncertain{0.2e-3, 0.01e-3, 100.0};
  return evidence;
}

// Joint 3 of an arm with rods turns its fourth axis, joint 6 the seventh.
TEST(GeometryChangeWords, SpeakOfJointsByTheirOwnNumbers) {
  CauseEvidence zero = causeOf(ChangeCause::joint_zero, 4, 3);
  EXPECT_EQ(reports::causeWords(zero).find("the zero of joint 3 moved by "), 0u) << reports::causeWords(zero);
  EXPECT_EQ(reports::causeWords(zero).find("axis"), std::string::npos);
  zero.same_line = 3;
  EXPECT_NE(reports::causeWords(zero).find("or what turns axis 3 did, which looks the same"), std::string::npos);
  const std::string turned = reports::causeWords(causeOf(ChangeCause::turn_about_last, 7, 6));
  EXPECT_EQ(turned.find("all reflectors turned about axis 7, or the zero of joint 6 moved"), 0u) << turned;
  const std::string follower = reports::causeWords(causeOf(ChangeCause::turn_about_last, 7, 0));
  EXPECT_EQ(follower.find("all reflectors turned about axis 7: "), 0u) << follower;
}

TEST(GeometryChangeWords, AZeroThatCoupledJointsTurnIsItsAxis) {
  EXPECT_EQ(reports::numberName({NumberKind::joint_zero, 4, 3}), "zero of joint 3");
  EXPECT_EQ(reports::numberName({NumberKind::joint_zero, 2, 0}), "zero of axis 2");
  EXPECT_EQ(reports::numberName({NumberKind::off_x, 3}), "axis 4 off axis 3, x");
  EXPECT_EQ(reports::numberName({NumberKind::tilt_y, 3}), "tilt of axis 4 to y of axis 3");
}

TEST(GeometryChangeWords, ReflectorsThatTurnedMayBeTheLastJointsZero) {
  comparison::GeometryChange change;
  change.reflectors_moved = true, change.reflectors_p = 1e-9;
  change.reflectors.resize(1);
  change.causes = {causeOf(ChangeCause::turn_about_last, 7, 6)};
  const auto said = [&change] {
    std::string all;
    for (const std::string& one : reports::changeWords(change)) all += one + "\n";
    return all;
  };
  EXPECT_NE(said().find("unless joint 6's zero moved"), std::string::npos) << said();
  change.causes = {causeOf(ChangeCause::joint_zero, 4, 3)};  // of the machine, which changed as well
  EXPECT_EQ(said().find("unless joint"), std::string::npos) << said();
}

}  // namespace geometry_change_words_test
}  // namespace stiffscope
