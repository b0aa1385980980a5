#include "core/campaign/joint_reading.h"

#include <gtest/gtest.h>

#include "core/io/units.h"

namespace stiffscope {
namespace joint_reading_test {

using campaign::JointConvention;
using campaign::JointReading;

// Half of the ninth decimal of a degree, 8.7e-12 rad.
constexpr double kExact = 1e-11;

JointVector degrees(double a, double b, double c, double d, double e, double f) {
  JointVector values(6);
  values << a, b, c, d, e, f;
  return values * io::kDegree;
}

TEST(JointReading, TheThirdFigureAgainstTheHorizontal) {
  const JointConvention fanuc({JointReading{2, 1.0, 0.0, 1}}, 6);
  // Joint 2 leans by 30 deg while the forearm stays level: the figure stays, the angle follows.
  EXPECT_LT((fanuc.angles(degrees(0, 30, 0, 0, 0, 0)) - degrees(0, 30, 30, 0, 0, 0)).norm(), kExact);
  EXPECT_LT((fanuc.figures(degrees(0, 30, 30, 0, 0, 0)) - degrees(0, 30, 0, 0, 0, 0)).norm(), kExact);
}

TEST(JointReading, SignOffsetAndSumsGoBothWays) {
  const JointConvention convention(
      {JointReading{0, -1.0, 0.3, -1}, JointReading{2, -1.0, -1.2, 1}, JointReading{4, 1.0, 0.0, 2}}, 6);
  EXPECT_TRUE(convention.invertible());
  const JointVector figures = degrees(10, -20, 30, 40, -50, 60);
  EXPECT_LT((convention.figures(convention.angles(figures)) - figures).norm(), kExact);
  // q5 adds the third figure, not the third angle.
  EXPECT_NEAR(convention.angles(figures)[4], -20.0 * io::kDegree, kExact);
}

TEST(JointReading, SumsAreTheNumbersThatTablesHold) {
  const JointConvention fanuc({JointReading{2, 1.0, 0.0, 1}}, 6);
  JointVector figures = JointVector::Zero(6);
  figures[1] = -17.06725 * io::kDegree;
  figures[2] = 19.82796 * io::kDegree;
  EXPECT_EQ(fanuc.angles(figures)[2], 2.76071 * io::kDegree);  // to the last bit
}

TEST(JointReading, JointsAddedInACircleAreNotInvertible) {
  EXPECT_FALSE(JointConvention({JointReading{1, 1.0, 0.0, 2}, JointReading{2, 1.0, 0.0, 1}}, 6).invertible());
}

TEST(JointReading, BlankFiguresTakeTheOtherFromBesideThem) {
  const JointConvention fanuc({JointReading{2, 1.0, 0.0, 1}}, 6);
  JointVector blank = JointVector::Constant(6, campaign::kNotGiven);
  blank[2] = 5.0 * io::kDegree;
  const JointVector angles = fanuc.anglesBeside(blank, degrees(0, 30, 0, 0, 0, 0));
  EXPECT_NEAR(angles[2], 35.0 * io::kDegree, kExact);
  EXPECT_TRUE(std::isnan(angles[1]));
}

TEST(JointReading, NothingChangesWithoutReadings) {
  campaign::Campaign day;
  day.states.emplace().rows.emplace_back(6);
  day.states->rows[0].q = degrees(1, 2, 3, 4, 5, 6);
  campaign::Campaign turned = day;
  campaign::figuresToAngles(turned);
  campaign::anglesToFigures(turned);
  EXPECT_EQ(turned.states->rows[0].q, day.states->rows[0].q);
}

}  // namespace joint_reading_test
}  // namespace stiffscope
