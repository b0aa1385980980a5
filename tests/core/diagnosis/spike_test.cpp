#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>
#include "core/diagnosis/spike_study.h"
#include "core/effects/all.h"
#include "core/preparation/rail.h"
#include "core/preparation/subsample.h"
#include "core/validation/machine_kinds.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"
#include "tests/fixtures/extended_day.h"
#include "tests/fixtures/on_one_core.h"
#include "tests/fixtures/station_day.h"

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

/// What a spike adds to a reading, in the axes of the first station.
template <class Row>
Eigen::Vector3d added(const Row& before, const Row& after) {
  const Eigen::Vector3d own = after.point - before.point;
  return before.station == 0 ? own : Eigen::Vector3d(secondStation().linear() * own);
}

/// One day in two forms, row by row the same readings, each with what it becomes by an effect.
struct TwoForms {
  const campaign::Campaign &one, &one_spiked, &other, &other_spiked;
};

template <class Table>
void expectSameMoves(const TwoForms& days, std::optional<Table> campaign::Campaign::*table, effects::Effect effect) {
  const auto& rows = (days.one.*table)->rows;
  double moved = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d one = added(rows[i], (days.one_spiked.*table)->rows[i]);
    const Eigen::Vector3d other = added((days.other.*table)->rows[i], (days.other_spiked.*table)->rows[i]);
    moved += one.squaredNorm();
    apart += (one - other).squaredNorm();
  }
  ASSERT_GT(moved, 0.0) << (days.one.*table)->file;
  // Both days are identified for themselves: from another place the same readings weigh otherwise.
  EXPECT_LT(std::sqrt(apart / moved), 1e-3) << effects::idOf(effect) << ", " << (days.one.*table)->file;
}

/// As good as exact; without any noise repeats would pass for copies of each other.
constexpr double kExact = 1e-6;

// Half of the postures, the wrist sweep and half of the nests read from another place, in a frame of its own: an effect
// moves the same reflectors by the same displacements.
TEST(SpikedDay, MovesWhatASecondStationReadsInItsOwnFrame) {
  const campaign::Campaign whole = simulation::simulate(cleanDay(5, kExact));
  campaign::Campaign split = seenFromTwo(whole, 10);
  for (campaign::WristReading& row : split.wrist_sweep->rows) {
    row.station = 1;
    row.point = secondStation().inverse() * row.point;
  }
  const diagnosis::SpikedDay one(whole), two(split);
  ASSERT_TRUE(one.unusable().empty() && two.unusable().empty());
  for (const effects::Effect effect :
       {effects::Effect::kinematic_error, effects::Effect::bearing_tilt, effects::Effect::tracker_drift}) {
    constexpr double kSize = 1e-4;
    numerics::RandomStream random(4, "station");
    const auto spike = one.draw(effect, kSize, random);
    ASSERT_TRUE(spike.has_value());
    const campaign::Campaign of_one = one.with(*spike, kSize), of_two = two.with(*spike, kSize);
    const TwoForms days{whole, of_one, split, of_two};
    expectSameMoves(days, &campaign::Campaign::loading, effect);
    expectSameMoves(days, &campaign::Campaign::circle_sweeps, effect);
    expectSameMoves(days, &campaign::Campaign::wrist_sweep, effect);
    if (effect == effects::Effect::tracker_drift) expectSameMoves(days, &campaign::Campaign::nests, effect);
  }
}

/// Of an arm on a rail, its carriage at 1.5 to 4.5 m.
campaign::Campaign railDay() {
  const auto folder = std::filesystem::temp_directory_path() / "stiffscope_spike_rail";
  std::filesystem::create_directories(folder);
  simulation::SimulationSpec spec =
      validation::drawMachineOfKind(validation::MachineKind::rail, 41, "case", folder / "robot.urdf").spec;
  spec.tracker.true_noise_factor = kExact;
  return simulation::simulate(spec);
}

// The same readings as they would be with the carriage at zero, which is where an arm of this geometry stands.
TEST(SpikedDay, TheCarriageIsNoLever) {
  const campaign::Campaign day = railDay();
  campaign::Campaign at_zero = day;
  preparation::referToCarriageAtZero(preparation::prepareCampaign(day).rail, at_zero);
  at_zero.rail_sweep.reset();
  ASSERT_GT((day.wrist_sweep->rows.front().point - at_zero.wrist_sweep->rows.front().point).norm(), 2.0);
  const diagnosis::SpikedDay one(day), other(at_zero);
  ASSERT_TRUE(one.unusable().empty() && other.unusable().empty());
  for (const effects::Effect effect : {effects::Effect::kinematic_error, effects::Effect::bearing_tilt}) {
    constexpr double kSize = 1e-4;
    numerics::RandomStream random(4, "rail");
    const auto spike = one.draw(effect, kSize, random);
    ASSERT_TRUE(spike.has_value());
    const campaign::Campaign of_one = one.with(*spike, kSize), of_other = other.with(*spike, kSize);
    const TwoForms days{day, of_one, at_zero, of_other};
    expectSameMoves(days, &campaign::Campaign::loading, effect);
    expectSameMoves(days, &campaign::Campaign::circle_sweeps, effect);
    expectSameMoves(days, &campaign::Campaign::wrist_sweep, effect);
  }
}

/// The readings' times and points as read, and what was added to each.
struct Moves {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> points, added;

  template <class Rows>
  void add(const Rows& before, const Rows& after) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      times.push_back(before[i].time_s);
      points.push_back(before[i].point);
      added.push_back(after[i].point - before[i].point);
    }
  }
};

// A drift is one motion of the instrument, whatever it reads and wherever the carriage stood: (t - t0) (w x p + v) in
// the frame of the readings. What no such motion fits is the rail's own tilt, some 3 mm beside levers of metres, and
// the seconds between the readings of one state.
TEST(SpikedDay, OnARailADriftIsOneMotionOfAllReadings) {
  const campaign::Campaign day = railDay();
  const diagnosis::SpikedDay spiked_day(day);
  ASSERT_TRUE(spiked_day.unusable().empty());
  Eigen::VectorXd motion(6);  // rad, m
  motion << 1e-4, -2e-4, 3e-4, 1e-4, 0.0, -1e-4;
  const diagnosis::Spike drift{
      effects::Effect::tracker_drift, modelOf(day, effects::Effect::tracker_drift), {}, motion, 1.0};
  const campaign::Campaign spiked = spiked_day.with(drift, 1.0);
  Moves moves;
  moves.add(day.circle_sweeps->rows, spiked.circle_sweeps->rows);
  moves.add(day.wrist_sweep->rows, spiked.wrist_sweep->rows);
  moves.add(day.rail_sweep->rows, spiked.rail_sweep->rows);
  moves.add(day.loading->rows, spiked.loading->rows);
  moves.add(day.nests->rows, spiked.nests->rows);
  const auto rows = 3 * static_cast<Eigen::Index>(moves.points.size());
  Eigen::MatrixXd columns(rows, 12);  // w, v, t0 w, t0 v
  Eigen::VectorXd right(rows);
  for (std::size_t i = 0; i < moves.points.size(); ++i) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const double hours = moves.times[i] / 3600.0;
    Eigen::Matrix<double, 3, 6> by_motion;
    by_motion << -metrology::crossMatrix(moves.points[i]), Eigen::Matrix3d::Identity();
    columns.middleRows<3>(row) << hours * by_motion, by_motion;
    right.segment<3>(row) = moves.added[i];
  }
  const Eigen::VectorXd left = right - columns * leastSquaresSolution(columns, right);
  ASSERT_GT(right.norm(), 1e-3);
  EXPECT_LT(left.norm(), 0.01 * right.norm());
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
