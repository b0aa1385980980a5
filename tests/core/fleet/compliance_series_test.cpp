#include "core/fleet/fleet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/numerics/distributions.h"
#include "tests/core/fleet/made_days.h"

namespace stiffscope::fleet {
namespace compliance_series_test {

constexpr identification::Method kMethod = identification::Method::partial_pose;

std::vector<const CampaignResult*> pointers(const std::vector<CampaignResult>& days) {
  std::vector<const CampaignResult*> all;
  for (const CampaignResult& day : days) all.push_back(&day);
  return all;
}

Eigen::VectorXd weights(std::initializer_list<double> values) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) all[i++] = value;
  return all;
}

SpringsOfDay& springs(CampaignResult& day) { return day.springs[static_cast<std::size_t>(kMethod)]; }

// (3 - 1)^2 + (-1 - 2)^2 + 4 + 5 = 22, of which 13 scatter with 6 degrees of freedom: 6 (22 / 13)^2.
TEST(ComplianceSeries, TwoDaysByHand) {
  std::vector<CampaignResult> days{dayOf({1.0, 2.0}, 10.0), dayOf({3.0, -1.0}, 12.0)};
  springs(days[0]).shared[1] = 4.0, springs(days[1]).shared[1] = 5.0;
  springs(days[0]).dof[1] = 7.0, springs(days[1]).dof[1] = 6.0;
  const ComplianceSeries series(pointers(days), kMethod);
  EXPECT_TRUE(series.samePostures());
  const comparison::Uncertain difference = series.contrast(1, weights({-1.0, 1.0}), {0, 1});
  EXPECT_DOUBLE_EQ(difference.value, 2.0);
  EXPECT_DOUBLE_EQ(difference.sd, std::sqrt(22.0));
  EXPECT_NEAR(difference.dof, 6.0 * 22.0 * 22.0 / (13.0 * 13.0), 1e-12);  // rounding of three products
}

// The same sum by the rule for two days of one machine, which stands elsewhere.
TEST(ComplianceSeries, TwoDaysAreAsAPairedFitHasThem) {
  std::mt19937_64 draws(5);
  std::normal_distribution<double> normal;
  std::vector<CampaignResult> days;
  comparison::PairedFit pair(6);
  pair.same_postures = true;
  pair.influences.resize(9);
  for (std::size_t t = 0; t < 2; ++t) {
    std::vector<double> influences(9);
    for (std::size_t p = 0; p < 9; ++p) {
      influences[p] = normal(draws);
      pair.influences[p][t] = JointVector::Zero(6);
      pair.influences[p][t][1] = influences[p];
    }
    days.push_back(dayOf(influences, 20.0 + normal(draws)));
    springs(days[t]).shared[1] = 0.3;
  }
  pair.before = springs(days[0]).compliance, pair.after = springs(days[1]).compliance;
  pair.shared_before[1] = pair.shared_after[1] = 0.3;
  pair.dof_before = springs(days[0]).dof, pair.dof_after = springs(days[1]).dof;
  const comparison::Uncertain expected = pair.difference(1);
  const comparison::Uncertain found =
      ComplianceSeries(pointers(days), kMethod).contrast(1, weights({-1.0, 1.0}), {0, 1});
  EXPECT_NEAR(found.value, expected.value, 1e-12);  // rounding alone
  EXPECT_NEAR(found.sd, expected.sd, 1e-12);
  EXPECT_NEAR(found.dof, expected.dof, 1e-9);
}

// Whatever the model misses in a posture on every day alike is no uncertainty of a difference.
TEST(ComplianceSeries, WhatEveryDayMissesCancels) {
  std::mt19937_64 draws(6);
  std::vector<CampaignResult> days = unchangedDays(draws, 6, 12), biased = days;
  std::normal_distribution<double> large(0.0, 50.0);
  for (std::size_t p = 0; p < 12; ++p) {
    const double missed = large(draws);
    for (CampaignResult& day : biased) springs(day).influences[p][1] += missed;
  }
  const Eigen::VectorXd step = weights({-0.5, -0.5, 0.25, 0.25, 0.25, 0.25});
  const comparison::Uncertain without = ComplianceSeries(pointers(days), kMethod).contrast(1, step, {0, 2});
  const comparison::Uncertain with = ComplianceSeries(pointers(biased), kMethod).contrast(1, step, {0, 2});
  EXPECT_NEAR(with.sd, without.sd, 1e-9 * without.sd);  // fifty times larger numbers cancel to their rounding
  EXPECT_EQ(with.value, without.value);
}

// Days err by as much as is stated, misfit aside: at the level 5 % at most one series in twenty has a step.
TEST(ComplianceSeries, UnchangedDaysHaveNoSteps) {
  std::mt19937_64 draws(7);
  constexpr int kSeries = 600;
  int alarms = 0, outside = 0, points = 0;
  for (int i = 0; i < kSeries; ++i) {
    const std::vector<CampaignResult> days = unchangedDays(draws, 8, 12);
    const ComplianceSeries series(pointers(days), kMethod);
    const std::vector<Step> steps = series.steps(1, 0.05);
    alarms += steps.empty() ? 0 : 1;
    for (const ControlChart::Point& point : series.chart(1, {}).points) {
      outside += point.outside ? 1 : 0;
      ++points;
    }
  }
  // Bonferroni over seven dates is on the safe side; 30 of 600 are expected at most, and 46 in one run of a thousand.
  EXPECT_LE(alarms, 46);
  EXPECT_GE(alarms, 3);  // a test that never speaks would be too safe: neighbouring dates share most of their days
  // Three standard deviations: 13 of 4800, and 27 in one run of a thousand.
  EXPECT_LE(outside, 27);
  EXPECT_EQ(points, 8 * kSeries);
}

TEST(ComplianceSeries, AStepIsFoundWhereItIs) {
  std::mt19937_64 draws(8);
  int found = 0, dated = 0, once = 0;
  constexpr int kSeries = 200;
  for (int i = 0; i < kSeries; ++i) {
    std::vector<CampaignResult> days = unchangedDays(draws, 10, 12);
    const std::size_t first = 2 + static_cast<std::size_t>(i) % 6;
    for (std::size_t t = first; t < days.size(); ++t) springs(days[t]).compliance[1] += 6.0;  // six standard deviations
    const std::vector<Step> steps = ComplianceSeries(pointers(days), kMethod).steps(1, 1e-4);
    found += steps.empty() ? 0 : 1;
    once += steps.size() == 1 ? 1 : 0;
    for (const Step& step : steps) {
      if (step.first != first) continue;
      ++dated;
      EXPECT_NEAR(step.difference.value, 6.0, 4.5 * step.difference.sd);  // 4.5 standard deviations: one in 10^5
      EXPECT_NEAR(step.before.value, 100.0, 4.5);
    }
  }
  // At the worst place two days against eight: 6 / sqrt(1/2 + 1/8) = 7.6 deviations, the limit of 1e-4 / 9 being
  // at 4.4. In one series of a hundred the sum is taken for larger than chance, and with its 12 degrees may not do: 2
  // of 200 are expected, 7 in one run of 300.
  EXPECT_GE(found, kSeries - 6);
  EXPECT_GE(dated, kSeries - 11);  // a neighbouring date is likelier where one day errs by three deviations
  EXPECT_GE(once, kSeries - 11);
}

TEST(ComplianceSeries, ThereAndBackAreTwoSteps) {
  std::mt19937_64 draws(9);
  std::vector<CampaignResult> days = unchangedDays(draws, 12, 12);
  for (std::size_t t = 4; t < 8; ++t) springs(days[t]).compliance[1] += 30.0;
  const std::vector<Step> steps = ComplianceSeries(pointers(days), kMethod).steps(1, 1e-4);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].first, 4u);
  EXPECT_EQ(steps[1].first, 8u);
  EXPECT_GT(steps[0].difference.value, 0.0);
  EXPECT_LT(steps[1].difference.value, 0.0);
  const ControlChart chart = ComplianceSeries(pointers(days), kMethod).chart(1, steps);
  for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(chart.points[t].outside, t >= 4 && t < 8) << t;
}

// Pairs of dates are looked at besides, and still at most `level` of the series have a step: of 2000 with ten dates 20
// and 100 are expected at most, 34 and 130 in one run of a thousand.
TEST(ComplianceSeries, PairsOfDatesCostNoFalseAlarms) {
  std::mt19937_64 draws(21);
  int rare = 0, usual = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<CampaignResult> days = unchangedDays(draws, 10, 12);
    const ComplianceSeries series(pointers(days), kMethod);
    rare += series.steps(1, 0.01).empty() ? 0 : 1;
    usual += series.steps(1, 0.05).empty() ? 0 : 1;
  }
  EXPECT_LE(rare, 34);
  EXPECT_LE(usual, 130);
  EXPECT_GE(usual, 20);
}

// Each step is the difference of the segments beside it, and not of all days before and after: by hand.
TEST(ComplianceSeries, TwoStepsAreDifferencesOfTheSegmentsBesideThem) {
  std::mt19937_64 draws(22);
  std::vector<CampaignResult> days = unchangedDays(draws, 10, 12);
  for (std::size_t t = 0; t < 10; ++t)
    springs(days[t]).compliance[1] = 100.0 + (t % 2 == 0 ? 0.1 : -0.1) + (t < 3 ? 0.0 : t < 7 ? 12.0 : 1.0);
  const ComplianceSeries series(pointers(days), kMethod);
  const std::vector<Step> steps = series.steps(1, 1e-4);
  ASSERT_EQ(steps.size(), 2u);
  const auto mean = [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t t = begin; t < end; ++t) sum += springs(days[t]).compliance[1];
    return sum / static_cast<double>(end - begin);
  };
  EXPECT_EQ(std::vector({steps[0].begin, steps[0].first, steps[0].end}), (std::vector<std::size_t>{0, 3, 7}));
  EXPECT_EQ(std::vector({steps[1].begin, steps[1].first, steps[1].end}), (std::vector<std::size_t>{3, 7, 10}));
  EXPECT_NEAR(steps[0].difference.value, mean(3, 7) - mean(0, 3), 1e-12);  // rounding of sums
  EXPECT_NEAR(steps[1].difference.value, mean(7, 10) - mean(3, 7), 1e-12);
  EXPECT_NEAR(steps[0].before.value, mean(0, 3), 1e-12);
  EXPECT_NEAR(steps[1].before.value, mean(3, 7), 1e-12);
  EXPECT_NEAR(steps[1].share().value, (mean(7, 10) - mean(3, 7)) / mean(3, 7), 1e-12);
  // One step alone is beyond chance, too: of nine dates, nine tenths of the level being theirs.
  EXPECT_DOUBLE_EQ(steps[1].p_value, 10.0 * ComplianceSeries::pOfNothing(steps[1].difference));
  const double third = 1.0 / 3.0;
  const comparison::Uncertain by_hand =
      series.contrast(1, weights({0, 0, 0, -0.25, -0.25, -0.25, -0.25, third, third, third}), {0, 3, 7});
  EXPECT_NEAR(steps[1].difference.sd, by_hand.sd, 1e-12);
}

// Of a change that is undone no single step need be beyond chance: the two are, of 36 pairs of dates.
TEST(ComplianceSeries, TwoStepsAreFoundWhereNoneShowsAlone) {
  std::mt19937_64 draws(27);
  std::vector<CampaignResult> days = unchangedDays(draws, 10, 12);
  for (std::size_t t = 0; t < 10; ++t) springs(days[t]).compliance[1] = t < 3 || t >= 7 ? 100.0 : 105.0;
  const ComplianceSeries series(pointers(days), kMethod);
  const Eigen::VectorXd single =
      weights({-1.0 / 3, -1.0 / 3, -1.0 / 3, 1.0 / 7, 1.0 / 7, 1.0 / 7, 1.0 / 7, 1.0 / 7, 1.0 / 7, 1.0 / 7});
  constexpr double kLevel = 1e-5;
  EXPECT_GT(ComplianceSeries::pOfNothing(series.contrast(1, single, {0, 3})), kLevel);
  const std::vector<Step> steps = series.steps(1, kLevel);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].first, 3u);
  EXPECT_EQ(steps[1].first, 7u);
  // A tenth of the level is theirs.
  for (const Step& step : steps) EXPECT_DOUBLE_EQ(step.p_value, 360.0 * ComplianceSeries::pOfNothing(step.difference));
  EXPECT_DOUBLE_EQ(series.pOfNoStep(1), std::max(steps[0].p_value, steps[1].p_value));
}

// Two changes at their dates, of their sizes, with intervals that hold the truth 95 times in 100: one that is undone
// (the mean of all days before the second is neither state), and two the same way (one is likeliest between them).
TEST(ComplianceSeries, TwoChangesAreFoundAsWhatTheyAre) {
  std::mt19937_64 draws(23);
  constexpr int kSeries = 300;
  for (const double second : {-8.0, 8.0}) {
    int dated = 0, held = 0, steps_dated = 0;
    for (int i = 0; i < kSeries; ++i) {
      std::vector<CampaignResult> days = unchangedDays(draws, 10, 12);
      for (std::size_t t = 4; t < 10; ++t) springs(days[t]).compliance[1] += t < 7 ? 8.0 : 8.0 + second;
      const std::vector<Step> steps = ComplianceSeries(pointers(days), kMethod).steps(1, 1e-4);
      dated += steps.size() == 2 && steps[0].first == 4 && steps[1].first == 7 ? 1 : 0;
      for (const Step& step : steps) {
        if (step.first != 4 && step.first != 7) continue;
        ++steps_dated;
        held +=
            std::abs(step.difference.value - (step.first == 4 ? 8.0 : second)) <= step.difference.expanded() ? 1 : 0;
      }
    }
    // Differences of three and four days: 8 / sqrt(1/3 + 1/4) = 10 deviations, 12 degrees of the sum at worst.
    EXPECT_GE(dated, kSeries - 15) << second;
    // 570 of 600 expected, 546 in one run of a hundred thousand.
    EXPECT_GE(held, steps_dated - 54) << second;
    EXPECT_LE(held, steps_dated - 8) << second;
  }
}

// Of many steps the first finding is two of them; further ones follow by halves, and all are estimated beside all.
TEST(ComplianceSeries, FourStepsAreFoundByHalves) {
  std::mt19937_64 draws(24);
  std::vector<CampaignResult> days = unchangedDays(draws, 15, 12);
  const std::vector<double> level{0.0, 20.0, 8.0, 30.0, 12.0};
  for (std::size_t t = 0; t < 15; ++t) springs(days[t]).compliance[1] += level[t / 3];
  const std::vector<Step> steps = ComplianceSeries(pointers(days), kMethod).steps(1, 1e-4);
  ASSERT_EQ(steps.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(steps[k].first, 3 * (k + 1));
    EXPECT_EQ(steps[k].begin, 3 * k);
    // Four and a half deviations, one in 10^5, of differences of three days each.
    EXPECT_NEAR(steps[k].difference.value, level[k + 1] - level[k], 4.5 * std::sqrt(2.0 / 3.0)) << k;
    EXPECT_NEAR(steps[k].before.value, 100.0 + level[k], 4.5 * std::sqrt(1.0 / 3.0)) << k;
  }
}

// A share of what may be zero or less is not known; that and when it changed is.
TEST(ComplianceSeries, OfACompliancelessJointNoShareIsStated) {
  for (const double base : {-40.0, 0.5}) {  // U of the mean of four days is about 1
    std::mt19937_64 draws(25);
    std::vector<CampaignResult> days = unchangedDays(draws, 8, 12);
    for (std::size_t t = 0; t < 8; ++t) springs(days[t]).compliance[1] += base - 100.0 + (t < 4 ? 0.0 : 10.0);
    const ComplianceSeries series(pointers(days), kMethod);
    const std::vector<Step> steps = series.steps(1, 1e-4);
    ASSERT_EQ(steps.size(), 1u) << base;
    EXPECT_EQ(steps[0].first, 4u);
    EXPECT_NEAR(steps[0].difference.value, 10.0, 4.5 * steps[0].difference.sd);
    EXPECT_FALSE(std::isfinite(steps[0].share().value)) << base;
    EXPECT_FALSE(std::isfinite(steps[0].share().low)) << base;
    const ControlChart chart = series.chart(1, steps);
    EXPECT_TRUE(chart.points.empty()) << base;
    EXPECT_TRUE(std::isfinite(chart.scatter)) << base;  // of the dates among each other: no share
  }
}

// What changes in the postures and is no spring's makes the difference as uncertain as it is.
TEST(ComplianceSeries, AMisfitThatComesWithADateIsUncertainty) {
  std::mt19937_64 draws(10);
  std::vector<CampaignResult> days = unchangedDays(draws, 8, 12);
  std::normal_distribution<double> large(0.0, 20.0);
  for (std::size_t p = 0; p < 12; ++p) {
    const double new_misfit = large(draws);
    for (std::size_t t = 4; t < 8; ++t) springs(days[t]).influences[p][1] += new_misfit;
  }
  for (std::size_t t = 4; t < 8; ++t) springs(days[t]).compliance[1] += 30.0;
  // 12 postures at 20 each: 69, beside which 30 is nothing; pooled it would be 50 standard deviations.
  EXPECT_TRUE(ComplianceSeries(pointers(days), kMethod).steps(1, 0.01).empty());
}

TEST(ComplianceSeries, OtherPosturesAreNotPooled) {
  std::mt19937_64 draws(11);
  std::vector<CampaignResult> days = unchangedDays(draws, 4, 12);
  days[2].loaded_postures[3].q[0] += 0.1;
  const ComplianceSeries series(pointers(days), kMethod);
  EXPECT_FALSE(series.samePostures());
  const comparison::Uncertain difference = series.contrast(1, weights({-1.0, 0.0, 1.0, 0.0}), {0});
  double scatter = 0.0;
  for (std::size_t p = 0; p < 12; ++p) {
    const double a = springs(days[0]).influences[p][1], b = springs(days[2]).influences[p][1];
    scatter += p == 3 ? a * a + b * b : (b - a) * (b - a);
  }
  EXPECT_NEAR(difference.sd, std::sqrt(scatter), 1e-12);
}

// Steps of the size that is said to be found nine times in ten are, of four hundred machines: 360 with a standard
// deviation of six. The p-value is that of the likeliest date, which can only find more.
TEST(ComplianceSeries, AStepOfTheStatedSizeIsFoundNineTimesInTen) {
  std::mt19937_64 draws(17);
  constexpr double kLevel = 0.01 / 60.0;
  int found = 0;
  for (int machine = 0; machine < 400; ++machine) {
    std::vector<CampaignResult> days = unchangedDays(draws, 8, 30);
    const double share = ComplianceSeries(pointers(days), kMethod).detectableStep(1, 4, kLevel);
    EXPECT_GT(share, 0.02);  // (4.8 + 1.28) sqrt(1/4 + 1/4) sigma of 1 %, as Student's t allows
    EXPECT_LT(share, 0.07);
    for (std::size_t t = 4; t < 8; ++t) springs(days[t]).compliance[1] += 100.0 * share;
    found += ComplianceSeries(pointers(days), kMethod).pOfNoStep(1) <= kLevel;
  }
  EXPECT_GT(found, 340);
  EXPECT_LT(found, 385);
}

TEST(ComplianceSeries, AJointThatADayDoesNotSeeHasNoChart) {
  std::mt19937_64 draws(12);
  std::vector<CampaignResult> days = unchangedDays(draws, 4, 12);
  springs(days[1]).identifiable[1] = false;
  const ComplianceSeries series(pointers(days), kMethod);
  EXPECT_FALSE(series.has(1));
  EXPECT_TRUE(series.steps(1, 1.0).empty());
  EXPECT_TRUE(series.chart(1, {}).points.empty());
}

}  // namespace compliance_series_test
}  // namespace stiffscope::fleet
