#include <gtest/gtest.h>

#include "core/identification/known_stiffness.h"
#include "core/identification/remarks.h"
#include "reports/words/remark_words.h"

namespace stiffscope {
namespace known_stiffness_test {

using identification::StiffnessEstimate;

/// k2 = 2e6 Nm/rad, of which c is known to 2 % by many degrees of freedom; the other joints are not seen.
StiffnessEstimate oneJoint() {
  StiffnessEstimate estimate(6);
  estimate.compliance[1] = 5e-7;
  estimate.identifiable[1] = true;
  estimate.covariance(1, 1) = estimate.parts.scatter(1, 1) = 1e-8 * 1e-8;
  estimate.scatter_dof[1] = 1e6;
  return estimate;
}

TEST(KnownStiffness, StandsInWhereTheDaySeesNothing) {
  StiffnessEstimate estimate = oneJoint();
  const auto used = identification::completeByKnown({{0, 4e6, 2e5, "maker"}, {1, 9e9, 1e8, "maker"}}, estimate);
  ASSERT_EQ(used.size(), 1u);
  EXPECT_EQ(used[0].joint, 0);
  EXPECT_TRUE(estimate.identifiable[0]);
  EXPECT_DOUBLE_EQ(estimate.compliance[0], 2.5e-7);
  EXPECT_NEAR(std::sqrt(estimate.covariance(0, 0)), 0.05 * 2.5e-7, 1e-18);  // 5 % of k is 5 % of c
  EXPECT_DOUBLE_EQ(estimate.compliance[1], 5e-7);                           // its own value stays
}

TEST(KnownStiffness, IsHeldAgainstTheDaysOwnValue) {
  const StiffnessEstimate estimate = oneJoint();
  // U of c is 1.96e-8. A known 1/c_k = 2.1e6 is 2.38e-8 away: within sqrt(U^2 + U_k^2) where it is known to 3 %
  // (U_k = 2.80e-8), and beyond where it is known to 1 % (0.93e-8, together 2.17e-8).
  EXPECT_TRUE(identification::contradictedKnown({{1, 2.1e6, 0.03 * 2.1e6, "maker"}}, estimate).empty());
  const auto remarks = identification::contradictedKnown({{1, 2.1e6, 0.01 * 2.1e6, "maker"}}, estimate);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(remarks[0].is(identification::RemarkId::known_stiffness_contradicted));
  EXPECT_EQ(reports::words(remarks[0]).rfind("k2 is known from maker as 2.1000 +- 0.0210", 0), 0u)
      << reports::words(remarks[0]);
  // Of a joint that the day does not see nothing is said.
  EXPECT_TRUE(identification::contradictedKnown({{0, 1.0, 0.1, "maker"}}, estimate).empty());
}

}  // namespace known_stiffness_test
}  // namespace stiffscope
