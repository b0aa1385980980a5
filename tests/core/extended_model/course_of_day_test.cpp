#include "core/extended_model/hidden_effects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace course_of_day_test {

constexpr int kPostures = 24;

/// A day of postures an hour apart, whose compliances change by `share` from its middle to its ends; Partial Pose's
/// equations with noise.
struct Day {
  campaign::Campaign campaign;
  identification::Identification at{6};

  explicit Day(double share, double noise = 1e-3) {
    campaign.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
    identification::MethodResult& method = at.methods[1];
    method.available = true;
    method.estimate.compliance = exampleCompliance();
    method.estimate.identifiable.assign(6, true);
    Noise random(17);
    for (int pose = 0; pose < kPostures; ++pose) {
      campaign::State state(6);
      state.pose = pose;
      state.time_s = 3600.0 * pose;
      campaign.states->rows.push_back(state);
      const double place = 2.0 * pose / (kPostures - 1) - 1.0;
      identification::CaseEquations one;
      one.posture = pose;
      one.matrix.resize(9, 6);
      for (Eigen::Index i = 0; i < one.matrix.size(); ++i) one.matrix(i) = 1000.0 * random.normal();
      one.right = (1.0 + share * place) * (one.matrix * method.estimate.compliance);
      const double size = one.right.norm() / 3.0;
      for (Eigen::Index i = 0; i < one.right.size(); ++i) one.right[i] += noise * size * random.normal();
      method.target_rows.push_back(one);
    }
  }

  extended_model::CourseOfDay course() const { return extended_model::courseOfDay(campaign, at); }
};

TEST(CourseOfDay, FindsAChangeAndItsSign) {
  for (const double share : {0.02, -0.05}) {
    const extended_model::CourseOfDay found = Day(share).course();
    EXPECT_NEAR(found.over_day, share, 0.05 * std::abs(share));
    EXPECT_GT(std::abs(found.over_day_t), 10.0);
    EXPECT_EQ(found.standing, 0.0);
  }
}

TEST(CourseOfDay, SaysNothingWithoutOne) {
  EXPECT_FALSE(Day(0.0).course().any());
  // A change of a hundredth of what scatters.
  EXPECT_FALSE(Day(2e-3, 0.2).course().any());
  Day untimed(0.05);
  untimed.campaign.states->rows[3].time_s = campaign::kNoTime;
  EXPECT_FALSE(untimed.course().any());
}

TEST(CourseOfDay, TheBudgetHoldsTwiceTheChange) {
  const Day day(0.02);
  extended_model::CourseOfDay course;
  course.over_day = 0.02;
  course.standing = 0.01;
  extended_model::Declared declared;
  extended_model::addCourse(course, day.at, declared);
  ASSERT_EQ(declared.columns.size(), 2u);
  EXPECT_EQ(declared.columns[0].source, extended_model::BudgetSource::standing_load);
  EXPECT_EQ(declared.columns[1].source, extended_model::BudgetSource::over_day);
  const JointVector& c = day.at.methods[1].estimate.compliance;
  EXPECT_TRUE(declared.columns[0].compliance[1].isApprox(0.02 * c));
  EXPECT_TRUE(declared.columns[1].compliance[1].isApprox(0.04 * c));
  EXPECT_TRUE(declared.columns[0].compliance[0].isZero());  // Complete Pose is not available
}

}  // namespace course_of_day_test
}  // namespace stiffscope
