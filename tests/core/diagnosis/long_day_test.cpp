#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>
#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/numerics/normal_equations.h"
#include "core/preparation/prepare.h"
#include "core/preparation/subsample.h"

namespace stiffscope {
namespace long_day_test {

campaign::Campaign sampleDay() {
  return campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
}

/// The sample's postures so many times, a tenth of a micrometre apart: readings alike to the last digit are copies.
campaign::Campaign repeated(int times) {
  const campaign::Campaign once = sampleDay();
  const int postures = static_cast<int>(once.pose_ids.size());
  campaign::Campaign day = once;
  for (int k = 1; k < times; ++k) {
    for (const std::string& id : once.pose_ids) day.pose_ids.push_back(id + "-" + std::to_string(k));
    for (campaign::State row : once.states->rows) {
      row.pose += k * postures;
      day.states->rows.push_back(row);
    }
    for (campaign::LoadingReading row : once.loading->rows) {
      row.pose += k * postures;
      row.point.array() += 1e-7 * k;
      day.loading->rows.push_back(row);
    }
  }
  return day;
}

TEST(EvenlySpread, AllWhereTheyAreFewElseAsManyAsMayBeFromEndToEnd) {
  EXPECT_TRUE(preparation::evenlySpreadIndices(0, 5).empty());
  EXPECT_EQ(preparation::evenlySpreadIndices(3, 4), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(preparation::evenlySpreadIndices(10, 4), (std::vector<std::size_t>{0, 2, 5, 7}));
  EXPECT_EQ(preparation::evenlySpreadIndices(10, 5), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  const auto spread = preparation::evenlySpreadIndices(1'000'003, 1000);
  ASSERT_EQ(spread.size(), 1000u);
  for (std::size_t k = 1; k < spread.size(); ++k) {
    EXPECT_GE(spread[k] - spread[k - 1], 1000u);
    EXPECT_LE(spread[k] - spread[k - 1], 1001u);
  }
  EXPECT_GE(spread.back(), 999'000u);
}

// A load that few postures have is among those that are taken for it.
TEST(EvenlySpread, PosturesOfTheStepsThatAreAskedForComeFirst) {
  campaign::Campaign day = repeated(3);
  const int rare = 99;
  for (const int pose : {7, 30, 44}) {
    for (campaign::State& row : day.states->rows)
      if (row.pose == pose && row.step == 3) row.step = rare;
    for (campaign::LoadingReading& row : day.loading->rows)
      if (row.pose == pose && row.step == 3) row.step = rare;
  }
  const std::vector<std::size_t> some = preparation::spreadPostures(day, 5, {rare});
  ASSERT_EQ(some.size(), 5u);
  for (const std::size_t pose : {7, 30, 44}) EXPECT_TRUE(std::find(some.begin(), some.end(), pose) != some.end());
  const std::vector<std::size_t> others = preparation::spreadPostures(day, 5, {3});
  for (const std::size_t pose : {7, 30, 44}) EXPECT_TRUE(std::find(others.begin(), others.end(), pose) == others.end());
}

TEST(EvenlySpread, KeepsTheRowsOfItsPosturesAndAllElse) {
  const campaign::Campaign all = sampleDay(), some = preparation::evenlySpread(all, 5);
  ASSERT_EQ(some.pose_ids.size(), 5u);
  const std::set<std::string> kept(some.pose_ids.begin(), some.pose_ids.end());
  const auto expectKept = [&](const auto& of, const auto& from) {
    std::size_t at = 0;
    for (const auto& row : from) {
      const std::string& id = all.pose_ids[static_cast<std::size_t>(row.pose)];
      if (!kept.contains(id)) continue;
      ASSERT_LT(at, of.size());
      EXPECT_EQ(of[at].line, row.line);
      EXPECT_EQ(some.pose_ids[static_cast<std::size_t>(of[at].pose)], id);
      ++at;
    }
    EXPECT_EQ(of.size(), at);
  };
  expectKept(some.states->rows, all.states->rows);
  expectKept(some.loading->rows, all.loading->rows);
  EXPECT_EQ(some.circle_sweeps->rows.size(), all.circle_sweeps->rows.size());
  EXPECT_EQ(some.nests->rows.size(), all.nests->rows.size());
  EXPECT_EQ(some.inputs.size(), all.inputs.size());
  EXPECT_EQ(some.tracker->model, all.tracker->model);
}

// A thousand postures of which every thirty-third bears a load: an even spread of a hundred has three of these thirty.
TEST(EvenlySpread, TakesAllLoadedPosturesOfADayThatHasFew) {
  campaign::Campaign day;
  day.states.emplace();
  day.loading.emplace();
  day.targets.resize(1);
  for (int pose = 0; pose < 1000; ++pose) {
    day.pose_ids.push_back(std::to_string(pose));
    const bool loaded = pose % 33 == 1 && pose / 33 < 30;
    for (int step = 0; step < (loaded ? 3 : 2); ++step) {
      campaign::State state(6);
      state.pose = pose;
      state.step = step;
      state.wrench_in_cell[2] = loaded && step == 1 ? 1000.0 : 10.0;  // N: a return to zero has a hook's weight
      day.states->rows.push_back(state);
      campaign::LoadingReading reading;
      reading.pose = pose;
      reading.step = step;
      day.loading->rows.push_back(reading);
    }
  }
  const auto isLoaded = [](std::size_t pose) { return pose % 33 == 1 && pose / 33 < 30; };
  const std::vector<std::size_t> hundred = preparation::spreadPostures(day, 100);
  ASSERT_EQ(hundred.size(), 100u);
  EXPECT_TRUE(std::is_sorted(hundred.begin(), hundred.end()));
  EXPECT_EQ(std::count_if(hundred.begin(), hundred.end(), isLoaded), 30);
  const std::vector<std::size_t> ten = preparation::spreadPostures(day, 10);
  ASSERT_EQ(ten.size(), 10u);
  EXPECT_TRUE(std::all_of(ten.begin(), ten.end(), isLoaded));
  EXPECT_EQ(preparation::evenlySpread(day, 100).pose_ids.size(), 100u);
  // A posture whose loaded state was not read shows no deflection.
  std::erase_if(day.loading->rows, [](const auto& row) { return row.pose == 1 && row.step == 1; });
  const std::vector<std::size_t> fewer = preparation::spreadPostures(day, 29);
  EXPECT_FALSE(std::count(fewer.begin(), fewer.end(), 1u));
}

TEST(EvenlySpread, TakesAsManyReadingsOfASweepOfEachAxisAndReflector) {
  const campaign::Campaign all = sampleDay(), some = preparation::evenlySpread(all, 100, 90);
  std::map<std::pair<int, int>, std::vector<std::size_t>> circles;
  for (const campaign::CircleReading& row : some.circle_sweeps->rows)
    circles[{row.axis, row.target}].push_back(row.line);
  ASSERT_EQ(circles.size(), 18u);  // six axes, three reflectors
  for (const auto& [kind, lines] : circles) {
    EXPECT_EQ(lines.size(), 5u);
    EXPECT_GT(lines.back() - lines.front(), 30u);  // of twenty readings that take turns, the first to the seventeenth
  }
  std::map<int, int> wrist;
  for (const campaign::WristReading& row : some.wrist_sweep->rows) ++wrist[row.target];
  EXPECT_GE(wrist.size(), 1u);
  for (const auto& [target, count] : wrist) EXPECT_EQ(count, static_cast<int>(90 / wrist.size()));
  EXPECT_TRUE(
      std::is_sorted(some.wrist_sweep->rows.begin(), some.wrist_sweep->rows.end(),
                     [](const campaign::WristReading& a, const campaign::WristReading& b) { return a.line < b.line; }));
  EXPECT_TRUE(preparation::hasLongSweep(all, 90));
  EXPECT_FALSE(preparation::hasLongSweep(all));
}

/// The noise and the drift are those of the whole day.
preparation::PreparedCampaign spreadAfterPreparation(const campaign::Campaign& day) {
  preparation::PreparedCampaign prepared = preparation::prepareCampaign(day);
  prepared.campaign = preparation::evenlySpread(prepared.campaign, preparation::kMostDiagnosed);
  return prepared;
}

// A million readings of a sweep would be seventeen gigabytes of equations.
TEST(Diagnose, OfALongSweepTheReadingsSpreadOverItTakePart) {
  campaign::Campaign day = sampleDay();
  const std::vector<campaign::WristReading> once = day.wrist_sweep->rows;
  while (day.wrist_sweep->rows.size() <= preparation::kMostSwept) {
    for (campaign::WristReading row : once) {
      row.point.array() += 1e-7 * static_cast<double>(day.wrist_sweep->rows.size() / once.size());
      day.wrist_sweep->rows.push_back(row);
    }
  }
  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  quick.only = effects::Effect::joint_coupling;
  const diagnosis::Diagnosis by_itself = diagnosis::diagnose(spreadAfterPreparation(day), quick),
                             whole = diagnosis::diagnose(day, quick);
  EXPECT_EQ(whole.gap.before, by_itself.gap.before);
  EXPECT_EQ(whole.gap.after, by_itself.gap.after);
  // Of its postures all took part: nothing is said of those.
  ASSERT_EQ(whole.verdict.reasons.size(), by_itself.verdict.reasons.size() + 1);
  EXPECT_TRUE(whole.verdict.reasons.back() == Remark(diagnosis::RemarkId::sweeps_thinned, 2000));
}

TEST(LowerTriangle, AddsToTheLowerTriangleAlone) {
  Eigen::MatrixXd matrix(3, 3), sum = Eigen::MatrixXd::Identity(3, 3), expected(3, 3);
  matrix << 1, 2, 4, 2, 3, 5, 4, 5, 6;
  numerics::LowerTriangle(matrix).addTo(2.0, sum);
  expected << 3, 0, 0, 4, 7, 0, 8, 10, 13;
  EXPECT_EQ(sum, expected);
}

// What is said of a long day's postures must name them as that day does, not as the hundred that took part are
// numbered.
TEST(Diagnose, ALongDayIsItsSpreadPosturesUnderTheirOwnNames) {
  campaign::Campaign day = repeated(11);
  const std::vector<std::string> names = day.pose_ids;
  ASSERT_GT(names.size(), preparation::kMostDiagnosed);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  quick.only = effects::Effect::joint_coupling;
  const preparation::PreparedCampaign spread = spreadAfterPreparation(day);
  const diagnosis::Diagnosis by_itself = diagnosis::diagnose(spread, quick),
                             whole = diagnosis::diagnose(std::move(day), quick);
  EXPECT_EQ(whole.gap.before, by_itself.gap.before);
  EXPECT_EQ(whole.gap.after, by_itself.gap.after);
  ASSERT_EQ(whole.at_points.size(), by_itself.at_points.size());
  ASSERT_FALSE(whole.at_points.empty());
  for (std::size_t i = 0; i < whole.at_points.size(); ++i) {
    EXPECT_EQ(names[static_cast<std::size_t>(whole.at_points[i].pose)],
              spread.campaign.pose_ids[static_cast<std::size_t>(by_itself.at_points[i].pose)]);
    EXPECT_EQ(whole.at_points[i].before, by_itself.at_points[i].before);
  }
  EXPECT_TRUE(whole.verdict.reasons.back() == Remark(diagnosis::RemarkId::postures_thinned, names.size(), 100));
}

/// The sample's first reflector under so many names more, each of its own noise: readings alike are copies.
campaign::Campaign withReflectors(int count) {
  campaign::Campaign day = sampleDay();
  const auto more = [&](auto& table) {
    const auto once = table->rows;
    for (int target = static_cast<int>(day.targets.size()); target < count; ++target) {
      for (auto row : once) {
        if (row.target != 0) continue;
        row.target = target;
        row.point.array() += 1e-7 * target;
        table->rows.push_back(row);
      }
    }
  };
  more(day.circle_sweeps);
  more(day.wrist_sweep);
  more(day.loading);
  while (static_cast<int>(day.targets.size()) < count)
    day.targets.push_back({"T" + std::to_string(day.targets.size()), std::nullopt});
  return day;
}

// Each reflector brings 22 unknowns of its motion in the nest, three of its place: a hundred took the diagnosis of six
// postures more than two minutes.
TEST(Diagnose, OfManyReflectorsTheFirstTakePart) {
  campaign::Campaign day = withReflectors(20);
  // The second was never read: another takes its place.
  std::erase_if(day.loading->rows, [](const campaign::LoadingReading& row) { return row.target == 1; });
  EXPECT_EQ(preparation::firstReflectors(day, preparation::kMostReflectors), 13u);
  EXPECT_EQ(preparation::firstReflectors(day, 19), 20u);
  EXPECT_EQ(preparation::firstReflectors(day, 25), 20u);

  preparation::PreparedCampaign first = preparation::prepareCampaign(day);
  first.campaign = preparation::ofFirstReflectors(first.campaign, preparation::kMostReflectors);
  ASSERT_EQ(first.campaign.targets.size(), 13u);
  for (const campaign::LoadingReading& row : first.campaign.loading->rows) ASSERT_LT(row.target, 13);
  for (const campaign::CircleReading& row : first.campaign.circle_sweeps->rows) ASSERT_LT(row.target, 13);
  first.campaign.targets.erase(first.campaign.targets.begin() + 12);  // what is not more than enough is taken as it is
  const auto last = [](const auto& row) { return row.target == 12; };
  std::erase_if(first.campaign.loading->rows, last);
  std::erase_if(first.campaign.circle_sweeps->rows, last);
  std::erase_if(first.campaign.wrist_sweep->rows, last);

  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  quick.only = effects::Effect::joint_coupling;
  const diagnosis::Diagnosis whole = diagnosis::diagnose(day, quick), twelve = diagnosis::diagnose(first, quick);
  EXPECT_EQ(whole.postures, twelve.postures);
  ASSERT_FALSE(whole.at_points.empty());
  for (const diagnosis::PointGap& one : whole.at_points) EXPECT_LT(one.target, 13);
  // The thirteenth adds readings of a place that the first has, with noise of its own: the gap hardly changes.
  EXPECT_NEAR(whole.gap.before, twelve.gap.before, 0.05 * twelve.gap.before);
  const auto says = [](const diagnosis::Diagnosis& one, const Remark& reason) {
    return std::find(one.verdict.reasons.begin(), one.verdict.reasons.end(), reason) != one.verdict.reasons.end();
  };
  EXPECT_TRUE(says(whole, Remark(diagnosis::RemarkId::reflectors_thinned, 20, 13)));
  EXPECT_FALSE(says(twelve, Remark(diagnosis::RemarkId::reflectors_thinned, 12, 12)));
}

}  // namespace long_day_test
}  // namespace stiffscope
