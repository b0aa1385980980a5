#include "core/campaign/check_campaign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope {
namespace check_campaign_test {

// More than two blocks of the rows that are checked at a time, 32,768.
constexpr int kRows = 70'000;

/// A state and a displacement a posture, on lines 2, 3 and so on.
campaign::Campaign longCampaign() {
  campaign::Campaign campaign;
  campaign.folder = "campaign";
  campaign.targets = {{"A", Eigen::Vector3d::Zero()}};
  campaign.load_cell.emplace();
  campaign.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
  campaign.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::tracker, {}};
  for (std::size_t j = 0; j < 6; ++j) {
    campaign.robot.axes_in_base_at_zero.emplace_back();
    campaign.robot.joint_names.push_back("joint " + std::to_string(j + 1));
    campaign.robot.limits.push_back({-180.0 * io::kDegree, 180.0 * io::kDegree});
  }
  for (int i = 0; i < kRows; ++i) {
    campaign.pose_ids.push_back("P" + std::to_string(i));
    campaign::State state(6);
    state.pose = i, state.step = 1, state.line = static_cast<std::size_t>(i) + 2;
    state.q.setConstant(20.0 * io::kDegree);
    campaign.states->rows.push_back(state);
    campaign::Displacement row;
    row.pose = i, row.step = 1, row.line = static_cast<std::size_t>(i) + 2;
    campaign.displacements->rows.push_back(row);
  }
  return campaign;
}

TEST(CheckCampaign, FindsNothingInALongOneThatIsRight) {
  std::vector<std::string> warnings;
  campaign::checkCampaign(longCampaign(), warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(CheckCampaign, WarnsOfMotorSidesThatAreNoAnglesOfTheJoint) {
  campaign::Campaign campaign = longCampaign();
  for (const int row : {5, 40'000}) {
    campaign::State& state = campaign.states->rows[static_cast<std::size_t>(row)];
    state.extras().motor_side[1] = -state.q[1];
    state.extras().motor_side[2] = state.q[2] + 0.1 * io::kDegree;
  }
  std::vector<std::string> warnings;
  campaign::checkCampaign(campaign, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "campaign/states.csv:7: m2_deg: '-20.00000': more than 2 deg from q2_deg (20.00000): not a motor's angle "
            "over the gear ratio, in the joint's sense; rows like this: 2");
}

TEST(CheckCampaign, OfTwoReadingsWithoutStateTheFirstIsNamed) {
  campaign::Campaign campaign = longCampaign();
  for (const int row : {69'000, 40'000}) campaign.displacements->rows[static_cast<std::size_t>(row)].step = 2;
  std::vector<std::string> warnings;
  try {
    campaign::checkCampaign(campaign, warnings);
    FAIL() << "expected an error";
  } catch (const io::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "campaign/displacements.csv:40002: pose, step: 'P40000, 2': expected a load state that states.csv has "
                 "a row for");
  }
}

TEST(CheckCampaign, StatesInAnyOrderAreFound) {
  campaign::Campaign campaign = longCampaign();
  std::reverse(campaign.states->rows.begin(), campaign.states->rows.end());
  std::vector<std::string> warnings;
  EXPECT_NO_THROW(campaign::checkCampaign(campaign, warnings));
}

TEST(CheckCampaign, AnglesOutsideLimitsAreCountedOverAllRowsAndTheFirstNamed) {
  campaign::Campaign campaign = longCampaign();
  // Half a degree within the margin of five, and beyond it, below and above.
  campaign.states->rows[10].q[2] = 184.5 * io::kDegree;
  for (const int row : {33'000, 66'000})
    campaign.states->rows[static_cast<std::size_t>(row)].q[2] = 190.0 * io::kDegree;
  campaign.states->rows[69'999].q[5] = -190.0 * io::kDegree;
  std::vector<std::string> warnings;
  campaign::checkCampaign(campaign, warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "campaign/states.csv:33002: q3_deg: '190.00': more than 5 deg outside the limits of joint 3 "
            "(-180.00 to 180.00 deg); rows like this: 2");
  EXPECT_NE(warnings[1].find("campaign/states.csv:70001: q6_deg: '-190.00'"), std::string::npos) << warnings[1];
}

}  // namespace check_campaign_test
}  // namespace stiffscope
