#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/audit/audit.h"
#include "core/audit/remarks.h"
#include "core/mistakes/cell_zero.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// A noise that is declared four times too large or too small is found and named, and no other. Days are simulated;
// STIFFSCOPE_AUDIT_DAYS=100 in the environment makes as many and prints the rates.

namespace stiffscope {
namespace declared_noise_test {

constexpr double kTrackerTimes = 4.0, kNone = 1.0;

struct NoiseDay {
  double tracker = kNone;    ///< declared over true
  double load_cell = kNone;  ///< the same
  bool repeats = true;
  bool bearings = false;  ///< as the sample's: circles and positions scatter by more than noise
};

campaign::Campaign dayOf(std::uint64_t seed, const NoiseDay& day) {
  simulation::SimulationSpec spec = cleanDay(seed, 1.0);
  if (day.bearings) {
    const simulation::SimulationSpec sample =
        simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
    for (std::size_t j = 0; j < 6; ++j) spec.machine.joints[j].bearing = sample.machine.joints[j].bearing;
  }
  campaign::Campaign campaign = simulation::simulate(spec);
  campaign::Tracker& tracker = *campaign.tracker;
  for (double* figure : {&tracker.range_fixed, &tracker.range_per_m, &tracker.angle_fixed, &tracker.angle_per_m})
    *figure *= day.tracker;
  campaign.load_cell->force_sigma *= day.load_cell;
  campaign.load_cell->moment_sigma *= day.load_cell;
  if (!day.repeats)
    std::erase_if(campaign.loading->rows, [](const campaign::LoadingReading& row) { return row.repeat != 1; });
  return campaign;
}

struct NoiseTally {
  int days = 0, tracker = 0, load_cell = 0;  ///< findings
  double least = INFINITY, most = 0.0;       ///< deviations found
};

NoiseTally tallyOf(const char* name, const NoiseDay& day, int days, std::uint64_t first_seed) {
  NoiseTally tally;
  tally.days = days;
  for (int i = 0; i < days; ++i) {
    const audit::AuditReport report = audit::audit(dayOf(first_seed + static_cast<std::uint64_t>(i), day));
    for (const preparation::AuditCheck& check : report.checks) {
      if (check.id != "noise_declared" || !check.value) continue;
      const bool found = check.verdict != preparation::AuditVerdict::pass;
      const bool of_tracker = check.where.is(audit::RemarkId::at_tracker);
      (of_tracker ? tally.tracker : tally.load_cell) += found;
      if (of_tracker != (day.load_cell == kNone)) continue;
      tally.least = std::min(tally.least, *check.value);
      tally.most = std::max(tally.most, *check.value);
    }
    EXPECT_EQ(report.suspected.empty(), day.tracker == kNone && day.load_cell == kNone) << name;
  }
  if (days > 20) {
    fmt::print("{}: found of the tracker {}, of the load cell {} of {} days; deviation {:.2f} to {:.2f}\n", name,
               tally.tracker, tally.load_cell, days, tally.least, tally.most);
  }
  return tally;
}

TEST(DeclaredNoise, CleanDaysBearItOut) {
  for (const bool repeats : {true, false}) {
    for (const bool bearings : {false, true}) {
      NoiseDay day;
      day.repeats = repeats;
      day.bearings = bearings;
      const NoiseTally tally = tallyOf("declared as it is", day, daysOr(3), 5001);
      EXPECT_EQ(tally.tracker, 0) << repeats << bearings;
      EXPECT_EQ(tally.load_cell, 0) << repeats << bearings;
      EXPECT_LT(tally.most, 1.5);
    }
  }
}

TEST(DeclaredNoise, FourTimesTooLargeIsNamed) {
  for (const bool repeats : {true, false}) {
    NoiseDay day{kTrackerTimes};
    day.repeats = repeats;
    const NoiseTally tally = tallyOf("tracker declared 4 times too large", day, daysOr(3), 6001);
    EXPECT_EQ(tally.tracker, tally.days);
    EXPECT_EQ(tally.load_cell, 0);
    // Repeats have 456 degrees of freedom along the beam, a sweep's circles 100: 3 and 7 %, three of them and the
    // smallest of seven.
    EXPECT_GT(tally.least, 3.5);
    EXPECT_LT(tally.most, 5.2);
  }
}

TEST(DeclaredNoise, FourTimesTooSmallIsNamed) {
  for (const bool repeats : {true, false}) {
    NoiseDay day{1.0 / kTrackerTimes};
    day.repeats = repeats;
    const NoiseTally tally = tallyOf("tracker declared 4 times too small", day, daysOr(3), 7001);
    EXPECT_EQ(tally.tracker, tally.days);
    EXPECT_EQ(tally.load_cell, 0);
    EXPECT_GT(tally.least, 3.0);
    EXPECT_LT(tally.most, 4.5);
  }
}

TEST(DeclaredNoise, BearingsThatGiveDoNotHideIt) {
  for (const double times : {kTrackerTimes, 1.0 / kTrackerTimes}) {
    NoiseDay day{times};
    day.bearings = true;
    EXPECT_EQ(tallyOf("with bearings", day, daysOr(2), 8001).tracker, daysOr(2)) << times;
  }
}

TEST(DeclaredNoise, TheLoadCellsLikewise) {
  for (const double times : {4.0, 0.25}) {
    NoiseDay day;
    day.load_cell = times;
    const NoiseTally tally = tallyOf("load cell declared wrong by 4", day, daysOr(3), 9001);
    EXPECT_EQ(tally.load_cell, tally.days) << times;
    EXPECT_EQ(tally.tracker, 0) << times;
    EXPECT_NEAR(tally.least, 4.0, 0.9);  // 108 degrees of freedom: 7 %, three of them
    EXPECT_NEAR(tally.most, 4.0, 0.9);
  }
}

TEST(DeclaredNoise, SaysWhatToDeclareInstead) {
  const audit::AuditReport report = audit::audit(dayOf(1, {kTrackerTimes}));
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::warn);
  ASSERT_EQ(report.suspected.size(), 1u);
  const mistakes::Suspected& one = report.suspected[0];
  EXPECT_EQ(one.mistake, "noise_declared");
  EXPECT_TRUE(one.where.is(audit::RemarkId::at_tracker));
  ASSERT_TRUE(one.remedy.is(audit::RemarkId::declare_tracker_noise));
  for (const double times : std::get<std::vector<double>>(one.remedy.values.at(0)))
    EXPECT_NEAR(times, 1.0 / kTrackerTimes, 0.03);  // 456 degrees of freedom: 3 %, four of them
  EXPECT_NEAR(one.before, 1.0 / kTrackerTimes, 0.06);
  EXPECT_NEAR(one.after, 1.0, 0.25);
  EXPECT_EQ(audit::audit(dayOf(1, {1.0 / kTrackerTimes})).verdict, preparation::AuditVerdict::fail);
}

// Quiet repeats within seconds are no proof: the day, from round to round and circle to circle, is as noisy as
// declared.
TEST(DeclaredNoise, QuietRepeatsOfANoisyDayAreNoFinding) {
  campaign::Campaign campaign = dayOf(11, {});
  std::map<std::tuple<int, int, int>, Eigen::Vector3d> first;
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    const auto [place, added] = first.try_emplace({row.pose, row.step, row.target}, row.point);
    if (!added) row.point = place->second + 0.1 * (row.point - place->second);
  }
  const audit::AuditReport report = audit::audit(campaign);
  EXPECT_TRUE(report.suspected.empty());
}

const preparation::AuditCheck& checkAt(const audit::AuditReport& report, const char* id, audit::RemarkId where) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == id && (check.id != "noise_declared" || check.where.is(where))) return check;
  }
  throw std::out_of_range(id);
}

/// Whether some suspicion asks for another noise of the load cell or the tracker.
bool suspectsNoise(const audit::AuditReport& report) {
  return std::any_of(report.suspected.begin(), report.suspected.end(),
                     [](const mistakes::Suspected& one) { return one.mistake == "noise_declared"; });
}

// Another noise would make such a day pass: the zero that drifts is named, with what takes it off, and no noise.
TEST(DeclaredNoise, ADriftOfTheCellsZeroIsNoNoise) {
  campaign::Campaign campaign = dayOf(21, {});
  Vector6d drift;  // over the day, twenty times the noise
  drift << 12.0, -8.0, 20.0, 6.0, 3.0, -2.0;
  const double first = campaign.states->rows.front().time_s, span = campaign.states->rows.back().time_s - first;
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell += (row.time_s - first) / span * drift;
  const audit::AuditReport report = audit::audit(campaign);
  EXPECT_FALSE(suspectsNoise(report));
  ASSERT_EQ(report.suspected.size(), 1u);
  const mistakes::Suspected& one = report.suspected.front();
  EXPECT_EQ(one.mistake, "not_tared");
  ASSERT_TRUE(one.remedy.is(audit::RemarkId::take_step_0_off)) << reports::words(one.remedy);
  EXPECT_NEAR(std::get<double>(one.remedy.values.at(0)), drift.head<3>().norm(), 2.0);  // to the last step 0
  EXPECT_NEAR(std::get<double>(one.remedy.values.at(1)), drift.tail<3>().norm(), 0.6);
  EXPECT_GT(one.before, 3.0);
  EXPECT_NEAR(one.after, 1.0, 0.25);
  EXPECT_EQ(checkAt(report, "noise_declared", audit::RemarkId::at_load_cell).verdict, preparation::AuditVerdict::pass);
  const preparation::AuditCheck& tare = checkAt(report, "tare", audit::RemarkId::at_load_cell);
  EXPECT_EQ(tare.verdict, preparation::AuditVerdict::warn);
  EXPECT_NE(reports::words(tare.message).find("its zero drifts"), std::string::npos) << reports::words(tare.message);

  // What the remedy asks for mends the day.
  std::map<int, Vector6d> zero;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step == 0) zero[row.pose] = row.wrench_in_cell;
  }
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell -= zero.at(row.pose);
  EXPECT_TRUE(audit::audit(campaign).suspected.empty());
}

TEST(DeclaredNoise, AWeightThatWasNotTaredIsNoNoise) {
  campaign::Campaign campaign = dayOf(22, {});
  constexpr double kMass = 6.0;  // kg
  const Eigen::Vector3d centre(0.0, 0.0, 0.1);
  for (campaign::State& row : campaign.states->rows) {
    const Eigen::Vector3d weight =
        kMass * mistakes::gravityInCell(campaign, campaign.robot, campaign.gravity_in_base, row.q);
    row.wrench_in_cell.head<3>() += weight;
    row.wrench_in_cell.tail<3>() += centre.cross(weight);
  }
  const mistakes::CellZero zero = mistakes::cellZero(campaign);
  EXPECT_TRUE(zero.weighs);
  EXPECT_FALSE(zero.drifts);
  EXPECT_NEAR(zero.mass, kMass, 0.1);
  const audit::AuditReport report = audit::audit(campaign);
  EXPECT_FALSE(suspectsNoise(report));
  ASSERT_FALSE(report.suspected.empty());
  EXPECT_EQ(report.suspected.front().mistake, "not_tared");
}

TEST(DeclaredNoise, MomentsInAnotherUnitAreNoNoise) {
  campaign::Campaign campaign = dayOf(23, {});
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell.tail<3>() *= 1e3;
  const audit::AuditReport report = audit::audit(campaign);
  ASSERT_FALSE(report.suspected.empty());
  EXPECT_EQ(report.suspected.front().mistake, "wrench_unit");
  EXPECT_FALSE(suspectsNoise(report));
  const preparation::AuditCheck& check = checkAt(report, "noise_declared", audit::RemarkId::at_load_cell);
  EXPECT_TRUE(check.message.is(audit::RemarkId::noise_explained)) << reports::words(check.message);
}

TEST(DeclaredNoise, IsSuspectedLast) {
  campaign::Campaign campaign = dayOf(24, {kTrackerTimes});
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell = -row.wrench_in_cell;
  const audit::AuditReport report = audit::audit(campaign);
  ASSERT_GE(report.suspected.size(), 2u);
  EXPECT_EQ(report.suspected.front().mistake, "wrench_sign");
  EXPECT_EQ(report.suspected.back().mistake, "noise_declared");
}

}  // namespace declared_noise_test
}  // namespace stiffscope
