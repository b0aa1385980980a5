#include "core/preparation/standing_motion.h"
#include <gtest/gtest.h>
#include <cmath>
#include <string>
#include "core/numerics/random.h"

namespace stiffscope {
namespace standing_motion_test {

constexpr int kPostures = 12, kRepeats = 3;

/// One reflector, three steps: 0.8 mm along y under load and back. `noise` (m) in every coordinate; a state moves on by
/// `creep` of its change of place from its first repeat to its last, evenly.
campaign::Campaign day(double noise, double creep) {
  campaign::Campaign campaign;
  campaign.loading.emplace();
  numerics::RandomStream random(7, "standing");
  for (int pose = 0; pose < kPostures; ++pose) {
    campaign.pose_ids.push_back(std::to_string(pose));
    double before = 0.0;
    for (int step = 0; step < 3; ++step) {
      const double place = step == 1 ? 0.8e-3 : 0.0;
      for (int repeat = 0; repeat < kRepeats; ++repeat) {
        campaign::LoadingReading row;
        row.pose = pose;
        row.step = step;
        row.repeat = repeat;
        row.point = Eigen::Vector3d(2.0, place + creep * (place - before) * (repeat - 1) / 2.0, 1.0 + 0.01 * pose);
        for (double& coordinate : row.point) coordinate += noise * random.normal();
        campaign.loading->rows.push_back(row);
      }
      before = place;
    }
  }
  return campaign;
}

// Repeats at -1/2, 0, 1/2 of the creep about a mean that stays: m = creep |u| to the last digit.
TEST(StandingMotion, IsTheShareThatItWasMadeWith) {
  const preparation::StandingMotion motion = preparation::standingMotion(day(0.0, 0.02));
  EXPECT_EQ(motion.states, 2 * kPostures);  // steps 1 and 2: loading and unloading creep alike
  EXPECT_NEAR(motion.share, 0.02, 1e-9);
  EXPECT_NEAR(motion.rms, 0.02 * 0.8e-3, 1e-12);
}

// The standard deviation of last less first is 1.41 * 5 um, of b 7.07 um / (0.8 mm * sqrt(24)) = 0.0018: 0.02 is eleven
// of them, far beyond the limit of the audit's level; none is within it.
TEST(StandingMotion, IsToldFromNoise) {
  const preparation::StandingMotion creeps = preparation::standingMotion(day(5e-6, 0.02));
  EXPECT_TRUE(creeps.significant()) << creeps.t << " " << creeps.limit;
  EXPECT_NEAR(creeps.share, 0.02, 4 * 0.0018);
  const preparation::StandingMotion stands = preparation::standingMotion(day(5e-6, 0.0));
  EXPECT_FALSE(stands.significant()) << stands.t << " " << stands.limit;
  EXPECT_LT(std::abs(stands.share), 4 * 0.0018);
}

TEST(StandingMotion, SaysNothingWithoutRepeats) {
  campaign::Campaign single = day(5e-6, 0.02);
  std::erase_if(single.loading->rows, [](const auto& row) { return row.repeat != 0; });
  EXPECT_EQ(preparation::standingMotion(single).states, 0);
  EXPECT_FALSE(preparation::standingMotion(single).significant());
  EXPECT_FALSE(preparation::standingMotion(campaign::Campaign{}).significant());
}

}  // namespace standing_motion_test
}  // namespace stiffscope
