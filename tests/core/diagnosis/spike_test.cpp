#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include "core/diagnosis/spike_study.h"
#include "core/effects/all.h"
#include "core/preparation/subsample.h"
#include "tests/fixtures/extended_day.h"
#include "tests/fixtures/on_one_core.h"

namespace stiffscope {
namespace spike_test {

campaign::Campaign quietDay(const simulation::SimulationSpec& spec) {
  return simulation::measureWithoutNoise(simulation::buildMachine(spec), spec);
}

std::size_t modelOf(const campaign::Campaign& campaign, effects::Effect effect) {
  const std::vector<effects::EffectModel> models = effects::effectModelsOf(campaign);
  const auto found = std::find_if(models.begin(), models.end(), [&](const auto& one) { return one.effect == effect; });
  return static_cast<std::size_t>(found - models.begin());
}

/// A day and what it becomes by an effect: `day` to `spiked` as it was added, `before` to `truth` as the simulator has
/// it, both of these without noise.
struct FourDays {
  const campaign::Campaign &day, &spiked, &before, &truth;
};

/// Root of the sum of squares of the true motions of the loading's readings, less those at step 0 where `deflections`,
/// and of what the added ones miss of them.
struct Compared {
  double moved = 0.0, apart = 0.0;
};

Compared compared(const FourDays& days, bool deflections) {
  std::map<std::pair<int, int>, std::array<Eigen::Vector3d, 2>> zeros;
  double moved = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < days.day.loading->rows.size(); ++i) {
    const campaign::LoadingReading& row = days.day.loading->rows[i];
    Eigen::Vector3d truth = days.truth.loading->rows[i].point - days.before.loading->rows[i].point;
    Eigen::Vector3d added = days.spiked.loading->rows[i].point - row.point;
    const std::pair key{row.pose, row.target};
    if (row.step == 0) zeros[key] = {truth, added};
    if (deflections) truth -= zeros.at(key)[0], added -= zeros.at(key)[1];
    moved += truth.squaredNorm();
    apart += (truth - added).squaredNorm();
  }
  return {std::sqrt(moved), std::sqrt(apart)};
}

// The simulator, which shares no formula with the effects, measures one machine with and without a bearing that gives:
// the spike of that compliance moves the readings as the simulator does. Springs and geometry are those identified, of
// a machine that has nothing else, and the field is of first order: 3 % of it are left open.
TEST(SpikedDay, MovesReadingsAsABearingThatGivesDoes) {
  simulation::SimulationSpec spec = springsAlone(5);
  const campaign::Campaign campaign = simulation::simulate(spec), before = quietDay(spec);
  constexpr double kCompliance = 4e-8;  // rad/Nm of joint 3, a quarter of the joint's own
  spec.machine.joints[2].bearing = 1.0 / kCompliance;
  const campaign::Campaign truth = quietDay(spec);
  const diagnosis::SpikedDay day(campaign);
  ASSERT_TRUE(day.unusable().empty());
  const diagnosis::Spike tilt{effects::Effect::bearing_tilt,
                              modelOf(campaign, effects::Effect::bearing_tilt),
                              {"joint 3"},
                              kCompliance * Eigen::VectorXd::Unit(6, 2),
                              1.0};
  const Compared found = compared({campaign, day.with(tilt, 1.0), before, truth}, true);
  ASSERT_GT(found.moved, 1e-4);
  EXPECT_LT(found.apart, 0.03 * found.moved);
}

// A motor that stands a milliradian off turns all beyond joint 3 in every reading: unloaded, loaded and swept.
TEST(SpikedDay, MovesEveryReadingAsAWrongZeroDoes) {
  simulation::SimulationSpec spec = springsAlone(5);
  const campaign::Campaign campaign = simulation::simulate(spec), before = quietDay(spec);
  PerJoint<simulation::AxisError> errors = simulation::drawAxisErrors(spec);
  constexpr double kZero = 1e-3;
  errors[2].zero += kZero;
  for (std::size_t i = 0; i < 6; ++i) spec.machine.geometry.listed[i] = errors[i];
  const campaign::Campaign truth = quietDay(spec);
  const diagnosis::SpikedDay day(campaign);
  const diagnosis::Spike zero{effects::Effect::kinematic_error, 0, {}, kZero * Eigen::VectorXd::Unit(8, 1), 1.0};
  const campaign::Campaign spiked = day.with(zero, 1.0);
  // 2 m turned by 1e-3 rad, to first order; own weight and load turn a little with it.
  const Compared found = compared({campaign, spiked, before, truth}, false);
  ASSERT_GT(found.moved, 1e-2);
  EXPECT_LT(found.apart, 0.01 * found.moved);
  double moved = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < campaign.wrist_sweep->rows.size(); ++i) {
    const Eigen::Vector3d true_move = truth.wrist_sweep->rows[i].point - before.wrist_sweep->rows[i].point;
    moved += true_move.squaredNorm();
    apart += (true_move - spiked.wrist_sweep->rows[i].point + campaign.wrist_sweep->rows[i].point).squaredNorm();
  }
  EXPECT_LT(std::sqrt(apart / moved), 0.01);
}

TEST(SpikedDay, OfSizeZeroIsTheDayItself) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(5));
  const diagnosis::SpikedDay day(campaign);
  for (const effects::Effect effect : {effects::Effect::bearing_tilt, effects::Effect::tracker_drift,
                                       effects::Effect::hysteresis, effects::Effect::kinematic_error}) {
    numerics::RandomStream random(1, "spike");
    const auto spike = day.draw(effect, 1e-5, random);
    ASSERT_TRUE(spike.has_value());
    const campaign::Campaign same = day.with(*spike, 0.0);
    for (std::size_t i = 0; i < campaign.loading->rows.size(); ++i)
      EXPECT_EQ(same.loading->rows[i].point, campaign.loading->rows[i].point);
    for (std::size_t i = 0; i < campaign.nests->rows.size(); ++i)
      EXPECT_EQ(same.nests->rows[i].point, campaign.nests->rows[i].point);
  }
}

// A reflector that moves under load: no other reading changes; a drift moves the nests along, nothing else does.
TEST(SpikedDay, MovesWhatTheEffectMovesAndNothingElse) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(5));
  const diagnosis::SpikedDay day(campaign);
  numerics::RandomStream random(3, "spike");
  const auto spike = day.draw(effects::Effect::target_motion, 1e-4, random);
  ASSERT_TRUE(spike.has_value());
  ASSERT_EQ(spike->parts.size(), 1u);
  const campaign::Campaign spiked = day.with(*spike, 1e-4);
  double own = 0.0, others = 0.0, unloaded = 0.0;
  for (std::size_t i = 0; i < campaign.loading->rows.size(); ++i) {
    const campaign::LoadingReading& row = campaign.loading->rows[i];
    const double moved = (spiked.loading->rows[i].point - row.point).norm();
    if (row.step == 0) unloaded += moved;
    (campaign.targets[static_cast<std::size_t>(row.target)].id == spike->parts[0] ? own : others) += moved;
  }
  EXPECT_GT(own, 0.0);
  EXPECT_EQ(others, 0.0);
  EXPECT_EQ(unloaded, 0.0);
  for (std::size_t i = 0; i < campaign.nests->rows.size(); ++i)
    EXPECT_EQ(spiked.nests->rows[i].point, campaign.nests->rows[i].point);
  const auto drift = day.draw(effects::Effect::tracker_drift, 1e-4, random);
  ASSERT_TRUE(drift.has_value());
  const campaign::Campaign drifted = day.with(*drift, 1e-4);
  EXPECT_GT((drifted.nests->rows.back().point - campaign.nests->rows.back().point).norm(), 0.0);
}

/// Of eight postures: a diagnosis costs a third.
campaign::Campaign shortDay() { return preparation::evenlySpread(simulation::simulate(springsAlone(5)), 8); }

diagnosis::DiagnoseOptions quick() {
  diagnosis::DiagnoseOptions options;
  options.resamples = 0;
  options.chance_draws = 50;
  return options;
}

// A hundredth of the smallest size that would have been seen is not; ten times that size is.
TEST(SpikeStudy, CountsWhatIsSeenAndWhatIsNot) {
  const campaign::Campaign campaign = shortDay();
  const diagnosis::Diagnosis baseline = diagnosis::diagnose(campaign, quick());
  const bool clean = std::none_of(
      baseline.verdict.entries.begin(), baseline.verdict.entries.end(),
      [](const auto& one) { return one.effects.empty() || one.effects.front() != effects::Effect::kinematic_error; });
  ASSERT_TRUE(clean);  // the samples' arm is off its nominal geometry
  diagnosis::SpikeOptions options;
  options.effects = {effects::Effect::target_motion, effects::Effect::hysteresis};
  options.sizes = {0.01, 10.0};
  options.draws = 3;
  std::size_t told = 0;
  const diagnosis::SpikeStudy study = diagnosis::spikeStudy(
      campaign, baseline, options, [&](std::size_t done, std::size_t total) { told += done == total ? 1 : 0; });
  EXPECT_EQ(told, 1u);
  ASSERT_EQ(study.effects.size(), 2u);
  EXPECT_EQ(study.effects[0].effect, effects::Effect::hysteresis);  // the vocabulary's order
  for (const diagnosis::SpikedEffect& one : study.effects) {
    EXPECT_FALSE(one.in_baseline);
    ASSERT_EQ(one.sizes.size(), 2u);
    EXPECT_NEAR(one.sizes[1].size, 10.0 * *one.detectable, 1e-15);
    EXPECT_EQ(one.sizes[0].draws, 3);
    EXPECT_EQ(one.sizes[0].named, 0) << effects::idOf(one.effect);
    EXPECT_EQ(one.sizes[0].other_named, 0);
    EXPECT_EQ(one.sizes[1].named, 3) << effects::idOf(one.effect);
    EXPECT_LE(one.sizes[1].class_size, 3.0);
  }
}

// Counts do not depend on the cores; another seed draws other joints.
TEST(SpikeStudy, IsTheSameOnOneCore) {
  const campaign::Campaign campaign = shortDay();
  const diagnosis::Diagnosis baseline = diagnosis::diagnose(campaign, quick());
  diagnosis::SpikeOptions options;
  options.effects = {effects::Effect::base_compliance};
  options.sizes = {1.0};
  options.draws = 4;
  const diagnosis::SpikeStudy all = diagnosis::spikeStudy(campaign, baseline, options);
  const OnOneCore alone;
  const diagnosis::SpikeStudy one = diagnosis::spikeStudy(campaign, baseline, options);
  ASSERT_EQ(all.effects.at(0).sizes.size(), 1u);
  EXPECT_EQ(all.effects[0].sizes[0].named, one.effects[0].sizes[0].named);
  EXPECT_EQ(all.effects[0].sizes[0].others, one.effects[0].sizes[0].others);
  const diagnosis::SpikedDay day(campaign);
  numerics::RandomStream first(1, "draw"), again(1, "draw"), second(2, "draw");
  const auto a = day.draw(effects::Effect::load_point_error, 1e-5, first);
  EXPECT_EQ(a->parameters, day.draw(effects::Effect::load_point_error, 1e-5, again)->parameters);
  EXPECT_NE(a->parameters, day.draw(effects::Effect::load_point_error, 1e-5, second)->parameters);
}

}  // namespace spike_test
}  // namespace stiffscope
