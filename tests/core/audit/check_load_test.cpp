#include <gtest/gtest.h>

#include "core/audit/redundancies.h"
#include "core/audit/remarks.h"
#include "tests/fixtures/chain_arm.h"

// A load that hangs at one point of the tool, its moments by hand: M = lever x F.

namespace stiffscope {
namespace check_load_test {

const Eigen::Vector3d kLever(0.1, -0.2, 0.3);  // m, flange axes
const std::vector<Eigen::Vector3d> kForces{{900, 0, 0},      {0, -1100, 0},    {0, 0, 1000},
                                           {600, 500, -700}, {-500, 800, 400}, {300, -600, 800}};  // N, the same

/// Loaded states in postures of their own, one before them without a load, which says nothing.
campaign::Campaign day(const std::vector<Eigen::Vector3d>& forces, bool in_base_axes = false) {
  const ChainArm chain = exampleChain();
  campaign::Campaign campaign;
  campaign.robot = chain.robot();
  campaign.base_link = "base_link", campaign.flange_link = "tool0";
  campaign::LoadCell& cell = campaign.load_cell.emplace();
  cell.parent = "tool0";
  if (in_base_axes) cell.axes_link = "base_link";
  cell.force_sigma = 0.5, cell.moment_sigma = 0.2;
  campaign.states.emplace().file = "states.csv";
  Noise noise(4);
  for (std::size_t i = 0; i <= forces.size(); ++i) {
    campaign::State state(chain.joints());
    state.pose = static_cast<int>(i);
    state.step = i == 0 ? 0 : 1;
    state.line = 2 + i;
    state.q = somePosture(noise);
    state.wrench_in_cell << 3.0, -2.0, 1.0, 0.4, 0.3, -0.2;
    if (i > 0) {
      const Eigen::Vector3d force = forces[i - 1], moment = kLever.cross(force);
      const Eigen::Matrix3d turn =
          in_base_axes ? chain.flangeAt(state.q).linear() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      state.wrench_in_cell << turn * force, turn * moment;
    }
    campaign.pose_ids.push_back(std::to_string(i + 1));
    campaign.states->rows.push_back(state);
  }
  return campaign;
}

TEST(LoadPoint, IsTheLeverOfTheMoments) {
  for (const bool in_base_axes : {false, true}) {
    const audit::LoadPointFit fit = audit::fitLoadPoint(day(kForces, in_base_axes));
    ASSERT_TRUE(fit.done) << in_base_axes;
    EXPECT_LT((fit.lever - kLever).norm(), 1e-9) << in_base_axes;
    EXPECT_EQ(fit.dof, 15);  // six states of three moments, less the lever
    EXPECT_LT(fit.chi2, 1e-9);
    EXPECT_TRUE(fit.mending_signs.empty());
  }
}

// The residual is known where the lever is: a wrong moment of 2 Nm against 0.2 Nm, widened by lever and force noise.
TEST(LoadPoint, AWrongSignIsFoundInItsState) {
  campaign::Campaign campaign = day(kForces);
  campaign.states->rows[4].wrench_in_cell[4] *= -1.0;
  const audit::LoadPointFit fit = audit::fitLoadPoint(campaign);
  ASSERT_TRUE(fit.done);
  EXPECT_GT(fit.worst_chi2, fit.worst_limit);
  EXPECT_EQ(fit.worst_line, 6u);
  EXPECT_EQ(fit.worst_pose, 4);
  EXPECT_EQ(fit.worst_step, 1);
  EXPECT_EQ(fit.mending_signs, std::vector<std::string>{"my"});
  EXPECT_FALSE(fit.mends_all_states);
}

TEST(LoadPoint, AWrongSignOfAllStatesIsOne) {
  campaign::Campaign campaign = day(kForces);
  for (campaign::State& state : campaign.states->rows) {
    state.wrench_in_cell[3] *= -1.0;
    state.wrench_in_cell[5] *= -1.0;
  }
  const audit::LoadPointFit fit = audit::fitLoadPoint(campaign);
  ASSERT_TRUE(fit.done);
  EXPECT_TRUE(fit.mends_all_states);
  // A lever turned round makes the same moments with all three signs: two signs are one sign and another lever.
  EXPECT_EQ(fit.mending_signs, std::vector<std::string>{"my"});
}

TEST(LoadPoint, SaysWhatIsMissing) {
  const std::vector<Eigen::Vector3d> few(kForces.begin(), kForces.begin() + 3);
  EXPECT_TRUE(audit::fitLoadPoint(day(few)).reason.is(audit::MissingId::few_loaded_states));
  campaign::Campaign without = day(kForces);
  for (campaign::State& state : without.states->rows) state.wrench_in_cell.tail<3>().setZero();
  EXPECT_TRUE(audit::fitLoadPoint(without).reason.is(audit::MissingId::no_moments));
  std::vector<Eigen::Vector3d> one_line;
  for (const double size : {700.0, 800.0, -900.0, 1000.0, 1100.0})
    one_line.emplace_back(size * Eigen::Vector3d::UnitZ());
  const audit::LoadPointFit fit = audit::fitLoadPoint(day(one_line));
  EXPECT_FALSE(fit.done);
  EXPECT_TRUE(fit.reason.is(audit::MissingId::forces_on_one_line));
}

}  // namespace check_load_test
}  // namespace stiffscope
