#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/audit/audit.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// A joint whose zero is another in the loading than it was in the sweeps.

namespace stiffscope {
namespace zero_since_sweeps_test {

preparation::AuditCheck positionsOf(const campaign::Campaign& campaign) {
  const audit::AuditReport report = audit::audit(campaign);
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [](const preparation::AuditCheck& one) { return one.id == "unloaded_positions"; });
}

campaign::Campaign dayWithZero(int joint, double off) {
  campaign::Campaign campaign = simulation::simulate(cleanDay(79, 1.0));
  for (campaign::State& row : campaign.states->rows) row.q[joint] += off;
  return campaign;
}

// The reported angle is larger than the arm's: the correction is its negative. Half a degree moves reflectors, half a
// metre from joint 4 or 5, by millimetres.
TEST(ZeroSinceSweeps, IsNamedWithItsJointAndSize) {
  for (const int joint : {2, 3, 4}) {
    const preparation::AuditCheck check = positionsOf(dayWithZero(joint, 0.5 * io::kDegree));
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail) << joint;
    const std::string words = reports::words(check.message);
    const std::string named = "where joint " + std::to_string(joint + 1) + " stands ";
    const std::size_t at = words.find(named);
    ASSERT_NE(at, std::string::npos) << words;
    EXPECT_NEAR(std::stod(words.substr(at + named.size())), -0.5, 6e-3) << words;  // deg; axes are off by 1e-4 rad
  }
}

TEST(ZeroSinceSweeps, NoneIsNamedOfACleanDay) {
  const preparation::AuditCheck check = positionsOf(dayWithZero(0, 0.0));
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_EQ(reports::words(check.message).find("stands"), std::string::npos) << reports::words(check.message);
}

// What the reflectors' places or the base's would do as well is not put down to a joint.
TEST(ZeroSinceSweeps, TheLastJointsIsTheToolsToo) {
  const preparation::AuditCheck check = positionsOf(dayWithZero(5, 0.5 * io::kDegree));
  EXPECT_EQ(reports::words(check.message).find("where joint"), std::string::npos) << reports::words(check.message);
}

}  // namespace zero_since_sweeps_test
}  // namespace stiffscope
