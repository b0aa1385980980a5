#include "core/identification/held_out_loads.h"

#include <gtest/gtest.h>

#include "core/identification/identify.h"
#include "core/identification/load_case.h"
#include "core/preparation/subsample.h"
#include "tests/fixtures/example_arm.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace held_out_loads_test {

using identification::HeldOutLoad;
using identification::LoadDirection;
using identification::Method;

identification::IdentifyOptions quick() {
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = 5;
  return options;
}

TEST(LoadDirections, AreOfTheLargestPart) {
  const Eigen::Vector3d point(1.0, 1.0, 0.5), gravity(0.0, 0.0, -9.8);
  const auto of = [&](double x, double y, double z) { return identification::directionOf({x, y, z}, point, gravity); };
  EXPECT_EQ(of(0, 0, -1), LoadDirection::down);
  EXPECT_EQ(of(0.5, 0.5, -1), LoadDirection::down);
  EXPECT_EQ(of(0, 0.1, 1), LoadDirection::up);
  EXPECT_EQ(of(1, 1, 0), LoadDirection::outward);
  EXPECT_EQ(of(-1, -0.5, 0.3), LoadDirection::inward);
  EXPECT_EQ(of(1, -1, 0), LoadDirection::sideways);
  EXPECT_EQ(of(-1, 0.5, 0.3), LoadDirection::sideways);
  // A tilted base: down is along gravity.
  EXPECT_EQ(identification::directionOf({0.9, 0, -0.5}, point, {5.0, 0.0, -5.0}), LoadDirection::down);
}

TEST(HeldOutLoads, SpringsHoldUnderDirectionsThatTookNoPart) {
  const SimulatedLab lab = springyLab();
  const campaign::Campaign campaign = fullDay(
      lab,
      [](int pose) {
        constexpr double kForce = 900.0;
        return pose % 2 == 0 ? Eigen::Vector3d(0.0, 0.0, -kForce) : Eigen::Vector3d(0.0, kForce, 0.2 * kForce);
      },
      24);
  const identification::Identification found = identification::identify(campaign, quick());
  const identification::HeldOutLoads loads = identification::heldOutLoads(campaign, campaign, quick(), found);
  int states = 0;
  for (const int one : loads.states) states += one;
  EXPECT_EQ(states, 24);
  EXPECT_EQ(loads.states[static_cast<std::size_t>(LoadDirection::down)], 12);
  for (const Method method : identification::kMethods) {
    const auto& directions = loads.directions[static_cast<std::size_t>(method)];
    ASSERT_GE(directions.size(), 2u);
    EXPECT_TRUE(loads.levels[static_cast<std::size_t>(method)].empty());
    for (const HeldOutLoad& one : directions) {
      const bool all_seen = !one.not_by_the_others[0];
      ASSERT_TRUE(one.at_targets && one.at_wrist);
      if (all_seen) {
        EXPECT_GT(*one.at_targets, 0.999) << static_cast<int>(*one.direction);
        EXPECT_GT(*one.at_wrist, 0.999);
      }
      if (*one.direction == LoadDirection::down) EXPECT_TRUE(all_seen);
    }
  }
}

// A pull to the side turns axis 1, which hanging loads do not: what joint 1 gives is left.
TEST(HeldOutLoads, AJointThatOtherLoadsDoNotTurnIsNamed) {
  SimulatedLab lab = springyLab();
  lab.compliance[0] *= 5.0;
  Noise noise(21);  // the postures of addLoading
  std::vector<Eigen::Vector3d> around;
  for (int pose = 0; pose < 24; ++pose) {
    const Eigen::Vector3d hook = lab.actual.flangeAt(somePosture(noise)) * lab.hook_in_flange;
    around.push_back(Eigen::Vector3d::UnitZ().cross(hook).normalized());
  }
  constexpr double kForce = 900.0;
  const auto force = [&](int pose) -> Eigen::Vector3d {
    return pose % 4 == 0 ? Eigen::Vector3d(kForce * around[static_cast<std::size_t>(pose)])
                         : Eigen::Vector3d(0.0, 0.0, -kForce);
  };
  const campaign::Campaign campaign = fullDay(lab, force, 24);
  const identification::Identification found = identification::identify(campaign, quick());
  const identification::HeldOutLoads loads = identification::heldOutLoads(campaign, campaign, quick(), found);
  for (const Method method : identification::kMethods) {
    const auto& directions = loads.directions[static_cast<std::size_t>(method)];
    ASSERT_EQ(directions.size(), 2u);
    EXPECT_EQ(directions[0].direction, LoadDirection::down);
    EXPECT_EQ(directions[1].direction, LoadDirection::sideways);
    EXPECT_EQ(directions[1].states, 6);
    EXPECT_NEAR(directions[1].mean_force, kForce, 0.01);
    EXPECT_TRUE(directions[1].not_by_the_others[0]);
    EXPECT_LT(*directions[1].at_targets, 0.9);
  }
}

// Step 1 of a machine a quarter softer than in step 2: of a displacement of 1.25 the springs of step 2 predict 1.
TEST(HeldOutLoads, ALevelIsPredictedByTheStepsThatIdentify) {
  const SimulatedLab lab = springyLab();
  SimulatedLab soft = lab;
  soft.compliance *= 1.25;
  const auto pull = [](double force) {
    return [force](int pose) -> Eigen::Vector3d {
      return force * Eigen::Vector3d(0.1 * (pose % 3), 0.2, -1.0).normalized();
    };
  };
  for (const SimulatedLab* light : {&lab, static_cast<const SimulatedLab*>(&soft)}) {
    campaign::Campaign campaign = fullDay(lab, pull(200.0), 12);
    for (campaign::State& row : campaign.states->rows) row.step = row.step == 1 ? 2 : row.step;
    for (campaign::LoadingReading& row : campaign.loading->rows) row.step = row.step == 1 ? 2 : row.step;
    const campaign::Campaign lighter = fullDay(*light, pull(100.0), 12);
    for (const campaign::State& row : lighter.states->rows)
      if (row.step == 1) campaign.states->rows.push_back(row);
    for (const campaign::LoadingReading& row : lighter.loading->rows)
      if (row.step == 1) campaign.loading->rows.push_back(row);
    const identification::Identification found = identification::identify(campaign, quick());
    ASSERT_EQ(found.step, 2);
    const identification::HeldOutLoads loads = identification::heldOutLoads(campaign, campaign, quick(), found);
    for (const Method method : identification::kMethods) {
      const auto& levels = loads.levels[static_cast<std::size_t>(method)];
      ASSERT_EQ(levels.size(), 1u);
      EXPECT_EQ(levels[0].step, 1);
      EXPECT_EQ(levels[0].states, 12);
      EXPECT_NEAR(levels[0].mean_force, 100.0, 0.1);
      EXPECT_NEAR(*levels[0].at_targets, light == &lab ? 1.0 : 0.8, 2e-3) << static_cast<int>(method);
      EXPECT_NEAR(*levels[0].at_wrist, light == &lab ? 1.0 : 0.8, 2e-3) << static_cast<int>(method);
    }
  }
}

// Of a long day so many postures, spread evenly over it, also where some disagree with the rest and are left out; and
// of loads that few postures have, all.
TEST(HeldOutLoads, OfALongDayAThousandPosturesOfEachKindArePredicted) {
  const SimulatedLab lab = springyLab();
  constexpr int kPostures = 2020, kUp = 5;
  const auto pull = [](int pose) -> Eigen::Vector3d {
    if (pose % 400 == 303) return {0.0, 0.0, 900.0};
    return pose % 2 == 0 ? Eigen::Vector3d(0.0, 0.0, -900.0) : Eigen::Vector3d(0.0, 0.0, -700.0);
  };
  const campaign::Campaign campaign = fullDay(lab, pull, kPostures);
  identification::Identification found = identification::identify(campaign, identification::estimatesOnly({}));
  for (const bool robust : {false, true}) {
    found.robust = robust;
    if (robust) found.outlying.emplace_back().posture = 7;
    const identification::HeldOutLoads loads = identification::heldOutLoads(campaign, campaign, quick(), found);
    int states = 0;
    for (const int one : loads.states) states += one;
    EXPECT_GE(states, static_cast<int>(preparation::kMostAveraged));
    EXPECT_LE(states, static_cast<int>(preparation::kMostAveraged) + 10);
    EXPECT_EQ(loads.states[static_cast<std::size_t>(LoadDirection::up)], kUp);
    const auto& directions = loads.directions[static_cast<std::size_t>(Method::partial_pose)];
    ASSERT_EQ(directions.size(), 2u);
    for (const HeldOutLoad& one : directions) {
      ASSERT_TRUE(one.at_targets);
      EXPECT_GT(*one.at_targets, 0.999);
    }
  }
}

TEST(HeldOutLoads, OfALongDayWithoutAMethodThereAreNone) {
  const campaign::Campaign campaign = fullDay(
      springyLab(),
      [](int) -> Eigen::Vector3d {
        return {0.0, 0.0, -900.0};
      },
      1020);
  const identification::HeldOutLoads loads =
      identification::heldOutLoads(campaign, campaign, quick(), identification::Identification(6));
  for (const Method method : identification::kMethods) {
    EXPECT_TRUE(loads.levels[static_cast<std::size_t>(method)].empty());
    EXPECT_TRUE(loads.directions[static_cast<std::size_t>(method)].empty());
  }
}

}  // namespace held_out_loads_test
}  // namespace stiffscope
