#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include "core/comparison/compare.h"
#include "core/comparison/stated_change.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace comparison_test {

identification::IdentifyOptions quick() {
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = 5;
  return options;
}

/// One day in the tests' own laboratory, `misfit` m of something unmodelled at each reflector that is the
/// same whenever `misfit_seed` is, and `noise` m of the tracker's.
campaign::Campaign day(const JointVector& compliance, std::uint64_t misfit_seed, double misfit,
                       std::uint64_t noise_seed, double noise, int postures = 12) {
  SimulatedLab lab;
  lab.compliance = compliance;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addWristSweep(campaign);
  lab.addLoading(campaign, postures, pulledForce);
  Noise unmodelled(misfit_seed), tracker(noise_seed);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    const Eigen::Vector3d shift = misfit * unmodelled.normal3();
    row.point += (row.step > 0 ? shift : Eigen::Vector3d::Zero()) + noise * tracker.normal3();
  }
  return campaign;
}

comparison::Comparison compared(const campaign::Campaign& before, const campaign::Campaign& after) {
  return comparison::compareCampaigns(before, identification::identify(before, quick()), after,
                                      identification::identify(after, quick()));
}

TEST(Comparison, FindsWhichJointWasStiffened) {
  JointVector stiffened = exampleCompliance();
  stiffened[2] /= 1.5;
  const comparison::Comparison found =
      compared(day(exampleCompliance(), 1, 0.0, 2, 5e-6), day(stiffened, 1, 0.0, 3, 5e-6));
  EXPECT_TRUE(found.comparable);
  EXPECT_EQ(found.matched.pairs.size(), 12u);
  for (const identification::Method method :
       {identification::Method::partial_pose, identification::Method::decoupled_partial_pose}) {
    const comparison::StiffnessChange& change = found.of(method);
    ASSERT_TRUE(change.available) << reports::words(change.reason);
    EXPECT_NEAR(change.joints[2].ratio.value, 1.5, 0.01);  // 5 um of noise in displacements of millimetres
    EXPECT_LT(change.joints[2].p_value, 1e-6);
    for (const std::size_t j : {0u, 1u, 4u}) {
      EXPECT_NEAR(change.joints[j].ratio.value, 1.0, 4.0 * change.joints[j].ratio.sd) << j;
      EXPECT_GT(change.joints[j].p_value, 1e-3) << j;
    }
  }
}

TEST(Comparison, ThePValueIsUniformWhereNothingChanged) {
  // 40 pairs of days of one machine whose unmodelled 60 um recur and whose noise does not, 6 joints. Uniform
  // on (0, 1), the mean over independent values has a standard deviation of 0.289 / sqrt(40) = 0.046 if the
  // joints of a day moved together; rejections at 5 % would be 12 of 240, a binomial of joints together
  // leaves 2 to 34 at 3 sigma.
  int rejected = 0, all = 0;
  double sum = 0.0, correlation = 0.0;
  std::vector<identification::Identification> days;
  std::vector<campaign::Campaign> campaigns;
  for (std::uint64_t k = 0; k < 41; ++k) {
    campaigns.push_back(day(exampleCompliance(), 5, 60e-6, 100 + k, 20e-6));
    days.push_back(identification::identify(campaigns.back(), quick()));
  }
  for (std::size_t k = 0; k + 1 < days.size(); ++k) {
    const comparison::MatchedPostures matched =
        comparison::matchPostures(campaigns[k], days[k], campaigns[k + 1], days[k + 1]);
    const comparison::StiffnessChange change = comparison::compareStiffness(
        campaigns[k], days[k], campaigns[k + 1], days[k + 1], identification::Method::partial_pose, matched);
    for (const comparison::JointChange& joint : change.joints) {
      rejected += joint.p_value < 0.05;
      sum += joint.p_value;
      correlation += joint.correlation;
      ++all;
    }
  }
  EXPECT_EQ(all, 240);
  EXPECT_NEAR(sum / all, 0.5, 3.5 * 0.046);
  EXPECT_LE(rejected, 34);
  // 60 um recur of sqrt(60^2 + 2 * 20^2) um in all (unloaded and loaded reading): 0.82 on average.
  EXPECT_NEAR(correlation / all, 0.82, 0.12);
}

TEST(Comparison, WithoutSharedPosturesNoCorrelationIsCounted) {
  campaign::Campaign before = day(exampleCompliance(), 1, 60e-6, 2, 5e-6),
                     after = day(exampleCompliance(), 1, 60e-6, 3, 5e-6);
  const comparison::Comparison shared = compared(before, after);
  for (std::string& id : after.pose_ids) id = "other " + id;
  const comparison::Comparison apart = compared(before, after);
  EXPECT_TRUE(apart.matched.pairs.empty());
  EXPECT_FALSE(apart.of(identification::Method::partial_pose).same_postures);
  EXPECT_TRUE(apart.cautions.front().is(comparison::RemarkId::other_postures));
  EXPECT_EQ(apart.matched.unmatched.size(), 24u);
  EXPECT_TRUE(apart.matched.unmatched.front().reason ==
              Remark(comparison::RemarkId::not_measured, comparison::When::after));
  EXPECT_FALSE(apart.avoided().available);
  EXPECT_TRUE(apart.avoided().reason.is(comparison::RemarkId::no_posture_in_both));
  const comparison::JointChange &with = shared.of(identification::Method::partial_pose).joints[1],
                                &no = apart.of(identification::Method::partial_pose).joints[1];
  EXPECT_GT(with.correlation, 0.9);
  EXPECT_EQ(no.correlation, 0.0);
  EXPECT_NEAR(no.ratio.sd, std::hypot(no.before.sd / no.before.value, no.after.sd / no.after.value) * no.ratio.value,
              1e-12);
  EXPECT_LT(with.ratio.sd, 0.5 * no.ratio.sd);
  EXPECT_LT(with.difference.sd, 0.5 * no.difference.sd);
}

TEST(Comparison, WhatBothStatesMissCancelsInTheDifference) {
  // 60 um that recur in every posture, 5 um of noise: the compliances of each state are off by tens of the difference's
  // uncertainty, the difference is not.
  JointVector softened = exampleCompliance();
  softened[1] *= 1.3;
  const comparison::Comparison found =
      compared(day(exampleCompliance(), 7, 60e-6, 2, 5e-6), day(softened, 7, 60e-6, 3, 5e-6));
  EXPECT_FALSE(found.residual.isNoise());
  EXPECT_LT(found.residual.recurs_p, 1e-3);
  EXPECT_GT(found.residual.correlation, 0.9);
  // Noise of unloaded and loaded reading in both states: 5 um times 2.
  EXPECT_NEAR(found.residual.of_difference, 10e-6, 2e-6);
  for (const comparison::StiffnessChange& change : found.methods) {
    ASSERT_TRUE(change.available && change.same_postures);
    EXPECT_EQ(change.postures, 12u);
    for (int j = 0; j < 6; ++j) {
      const comparison::JointChange& joint = change.joints[static_cast<std::size_t>(j)];
      const double truth = softened[j] - exampleCompliance()[j];
      // t of six degrees and more exceeds 6 once in a thousand; of 18 numbers.
      EXPECT_NEAR(joint.difference.value, truth, 6.0 * joint.difference.sd) << j;
      EXPECT_LT(joint.difference.sd, 0.3 * std::hypot(joint.before.sd / std::pow(joint.before.value, 2),
                                                      joint.after.sd / std::pow(joint.after.value, 2)))
          << j;
      EXPECT_GE(joint.p_holm, joint.p_value);
    }
    EXPECT_LT(change.joints[1].p_holm, 1e-4);
  }
}

TEST(Comparison, ADifferenceThatIsMoreThanJointsIsCautionedOf) {
  // Another misfit in every posture of the second day: 60 um each, where 5 um twice in each state are noise.
  campaign::Campaign before = day(exampleCompliance(), 7, 60e-6, 2, 5e-6),
                     other = day(exampleCompliance(), 8, 60e-6, 3, 5e-6),
                     same = day(exampleCompliance(), 7, 60e-6, 4, 5e-6);
  for (campaign::Campaign* one : {&before, &other, &same}) {
    one->tracker = campaign::Tracker{"tracker", 5e-6, 0.0, 5e-6, 0.0, Eigen::Vector3d::Zero()};
  }
  const auto cautioned = [&](const campaign::Campaign& after) {
    const comparison::Comparison found = compared(before, after);
    EXPECT_FALSE(found.residual.isNoise());
    return std::any_of(found.cautions.begin(), found.cautions.end(),
                       [](const Remark& one) { return one.is(comparison::RemarkId::difference_above_noise); });
  };
  EXPECT_TRUE(cautioned(other));
  EXPECT_FALSE(cautioned(same));
}

TEST(Comparison, NoiseAloneIsCalledNoise) {
  const comparison::Comparison found =
      compared(day(exampleCompliance(), 7, 0.0, 2, 20e-6), day(exampleCompliance(), 7, 0.0, 3, 20e-6));
  EXPECT_GT(found.residual.recurs_p, 1e-3);
  EXPECT_LT(std::abs(found.residual.correlation), 0.4);  // 102 degrees of freedom: four standard deviations
}

TEST(Comparison, JointsAndARestMakeUpTheDeflectionAvoided) {
  // Without noise all of what is avoided is the joints': a rest is of second order in deflections of millimetres.
  JointVector stiffened = exampleCompliance();
  stiffened[1] *= 0.6, stiffened[2] *= 0.7, stiffened[4] *= 1.1;
  const comparison::Comparison found =
      compared(day(exampleCompliance(), 1, 0.0, 2, 0.0), day(stiffened, 1, 0.0, 3, 0.0));
  for (const comparison::StiffnessChange& change : found.methods) {
    ASSERT_TRUE(change.available);
    double sum = 0.0;
    for (const comparison::JointChange& joint : change.joints) sum += joint.avoided.value;
    EXPECT_NEAR(sum + change.avoided_rest, found.at_targets.share, 1e-12);
    EXPECT_LT(std::abs(change.avoided_rest), 0.002);
    EXPECT_NEAR(change.joints[1].taken.value, 0.4, 0.002);
    EXPECT_NEAR(change.joints[2].taken.value, 0.3, 0.002);
    EXPECT_LT(change.joints[4].avoided.value, 0.0);
    EXPECT_NEAR(change.joints[3].avoided.value, 0.0, 0.001);
  }
}

TEST(PairedFit, UncertaintiesByHand) {
  comparison::PairedFit fit(6);
  fit.same_postures = true;
  fit.before[0] = 4.0, fit.after[0] = 3.0;
  const auto moved = [](double by) { return JointVector(by * JointVector::Unit(6, 0)); };
  fit.influences = {{moved(1.0), moved(1.5)}, {moved(-2.0), moved(-1.0)}};
  fit.dof_before[0] = 7.0, fit.dof_after[0] = 5.0;
  fit.shared_before[0] = 0.25, fit.shared_after[0] = 0.5;
  const comparison::Uncertain difference = fit.difference(0);
  EXPECT_DOUBLE_EQ(difference.value, -1.0);
  EXPECT_DOUBLE_EQ(difference.sd * difference.sd, 0.25 + 1.0 + 0.25 + 0.5);  // (1.5 - 1)^2 + (-1 + 2)^2, and shared
  EXPECT_DOUBLE_EQ(difference.dof, 5.0 * std::pow(2.0 / 1.25, 2));
  // t of 12 degrees 2.1788, of 13 2.1604: of 12.8 2.1638.
  EXPECT_NEAR(difference.expanded(), 2.1638 * std::sqrt(2.0), 0.001);
  EXPECT_DOUBLE_EQ(fit.correlation(0), (1.5 + 2.0) / std::sqrt(5.0 * 3.25));
  const comparison::Uncertain taken = fit.shareTaken(0);  // 1 - a / b: weights 3/16 and -1/4
  EXPECT_DOUBLE_EQ(taken.value, 0.25);
  EXPECT_NEAR(taken.sd * taken.sd,
              std::pow(3.0 / 16 - 1.5 / 4, 2) + std::pow(-6.0 / 16 + 1.0 / 4, 2) + 9.0 / 256 * 0.25 + 0.5 / 16, 1e-15);
  fit.same_postures = false;  // Welch and Satterthwaite of 5 (7 degrees) and 3.25 (5)
  EXPECT_NEAR(fit.difference(0).dof, std::pow(8.25, 2) / (25.0 / 7.0 + 3.25 * 3.25 / 5.0) * std::pow(2.0 / 1.25, 2),
              1e-12);
}

TEST(Holm, TheTextbookCase) {
  // 0.01, 0.02, 0.03, 0.04 of four: 0.04, 0.06, 0.06, 0.06; a number that is none is no test.
  const std::vector<double> corrected = comparison::holm({0.04, std::nan(""), 0.01, 0.03, 0.02});
  EXPECT_NEAR(corrected[2], 0.04, 1e-15);
  EXPECT_NEAR(corrected[4], 0.06, 1e-15);
  EXPECT_NEAR(corrected[3], 0.06, 1e-15);
  EXPECT_NEAR(corrected[0], 0.06, 1e-15);
  EXPECT_TRUE(std::isnan(corrected[1]));
  EXPECT_EQ(comparison::holm({0.6, 0.7}), (std::vector<double>{1.0, 1.0}));
}

TEST(Comparison, AnotherPostureOrLoadIsNamed) {
  campaign::Campaign before = day(exampleCompliance(), 1, 0.0, 2, 0.0),
                     after = day(exampleCompliance(), 1, 0.0, 2, 0.0);
  for (campaign::State& state : after.states->rows) {
    if (state.pose == 0) state.q[3] += 0.5 * std::numbers::pi / 180.0;
    if (state.pose == 1) state.wrench_in_cell *= 1.1;
  }
  std::erase_if(after.loading->rows,
                [](const campaign::LoadingReading& row) { return row.pose == 2 && row.step == 1; });
  const comparison::Comparison found = compared(before, after);
  EXPECT_EQ(found.matched.pairs.size(), 9u);
  ASSERT_EQ(found.matched.unmatched.size(), 3u);
  EXPECT_EQ(reports::words(found.matched.unmatched[0].reason),
            "joint 4 stands 0.500 deg apart, at most 0.010 is the same posture");
  EXPECT_EQ(reports::words(found.matched.unmatched[1].reason).substr(0, 27), "the loads differ by 9.1 % (");
  EXPECT_EQ(reports::words(found.matched.unmatched[2].reason),
            "left out after: no reflector was read both unloaded and in this load step");
}

TEST(Comparison, InheritsTheCautionsOfIdentification) {
  const campaign::Campaign clean = day(exampleCompliance(), 1, 0.0, 2, 5e-6);
  campaign::Campaign turned = clean;
  for (campaign::State& row : turned.states->rows) row.wrench_in_cell *= -1.0;
  EXPECT_TRUE(compared(clean, clean).cautions.empty());
  const comparison::Comparison found = compared(clean, turned);
  ASSERT_EQ(found.cautions.size(), 2u);
  EXPECT_TRUE(found.cautions[0].is(comparison::RemarkId::other_postures)) << reports::words(found.cautions[0]);
  EXPECT_EQ(reports::words(found.cautions[1]).rfind("after: every stiffness is negative", 0), 0u)
      << reports::words(found.cautions[1]);
}

TEST(Comparison, OneMachineHasOneUrdf) {
  const campaign::Campaign before = day(exampleCompliance(), 1, 0.0, 2, 0.0);
  EXPECT_TRUE(compared(before, before).cautions.empty());
  campaign::Campaign after = before;
  after.robot.name = "another";
  after.robot.bodies[3].mass_kg += 150.0;
  after.robot.base_from_flange_at_zero.translation().x() += 0.2;
  const comparison::Comparison found = compared(before, after);
  EXPECT_TRUE(found.comparable);  // the same axes
  ASSERT_GE(found.cautions.size(), 3u);
  EXPECT_EQ(reports::words(found.cautions[0]),
            "the URDFs name different machines: " + before.robot.name + " and another");
  EXPECT_EQ(reports::words(found.cautions[1]), "the URDFs place the flange 200.0 mm and 0.00 deg apart");
  EXPECT_TRUE(found.cautions[2].is(comparison::RemarkId::other_masses)) << reports::words(found.cautions[2]);
}

TEST(Comparison, OneMachineHasTheSameBalancers) {
  campaign::Campaign before = day(exampleCompliance(), 1, 0.0, 2, 0.0);
  before.robot.balancers = {{robot::SpringLaw{2e3, 500.0, 0.9}, {1, {-0.3, 0, 0.9}}, {2, {0.4, 0, 1.3}}, {}, {}}};
  campaign::Campaign after = before;
  // The same spring, stated at another length.
  after.robot.balancers[0].law = robot::SpringLaw{2e3, 700.0, 1.0};
  EXPECT_TRUE(compared(before, after).cautions.empty());
  after.robot.balancers[0].law = robot::SpringLaw{2e3, 900.0, 0.9};
  const comparison::Comparison found = compared(before, after);
  ASSERT_FALSE(found.cautions.empty());
  EXPECT_EQ(reports::words(found.cautions[0]).rfind("the campaigns state different balancers, 1 and 1 of them", 0), 0u)
      << reports::words(found.cautions[0]);
}

TEST(Comparison, DifferentMachinesAreNotCompared) {
  campaign::Campaign before = day(exampleCompliance(), 1, 0.0, 2, 0.0), after = before;
  after.robot.axes_in_base_at_zero[2].point.x() += 0.2;
  const comparison::Comparison found = compared(before, after);
  EXPECT_FALSE(found.comparable);
  EXPECT_EQ(reports::words(found.reason), "the URDFs describe different machines: axis 3 stands 200.0 mm elsewhere");
}

TEST(DeflectionAvoided, SharesOfSumsByHand) {
  const comparison::DeflectionAvoided found =
      comparison::shareAvoided({{"a", 2.0, 1.0}, {"b", 1.0, 1.0}, {"c", 1.0, 0.0}});
  EXPECT_DOUBLE_EQ(found.share, 0.5);
  EXPECT_DOUBLE_EQ(found.postures[0].share(), 0.5);
  EXPECT_TRUE(std::isnan(found.low));  // three postures: no interval
  EXPECT_TRUE(comparison::shareAvoided({{"a", 0.0, 1.0}}).reason.is(comparison::RemarkId::nothing_moved_before));
}

TEST(DeflectionAvoided, TheIntervalCoversWhatMorePosturesWouldGive) {
  // Postures drawn from one population whose share is 0.4; 400 campaigns each. Binomial at 95 %: 1.1 %, so at least 91
  // % beyond 3 sigma, and not all. Quantiles of the draws alone hold 84 % with five postures, 92 % with nineteen.
  for (const int count : {5, 8, 19}) {
    int covered = 0;
    Noise noise(11);
    for (int campaign = 0; campaign < 400; ++campaign) {
      std::vector<comparison::PostureDeflection> postures;
      for (int k = 0; k < count; ++k) {
        const double before = 1.0 + noise.uniform(), share = 0.4 + 0.1 * noise.normal();
        postures.push_back({std::to_string(k), before, before * (1.0 - share)});
      }
      comparison::BootstrapOptions options;
      options.samples = 500;
      const comparison::DeflectionAvoided found = comparison::shareAvoided(postures, options);
      covered += found.low <= 0.4 && 0.4 <= found.high;
    }
    EXPECT_GE(covered, 364) << count;
    EXPECT_LT(covered, 400) << count;
  }
}

TEST(StatedChanges, AddUncertaintiesInSquares) {
  using comparison::StatedCompliance;
  const std::vector<std::optional<StatedCompliance>> before{StatedCompliance{10.0, {7.0, 12.0}},
                                                            StatedCompliance{1.0, {0.9, 1.1}}, std::nullopt};
  const std::vector<std::optional<StatedCompliance>> after{
      StatedCompliance{30.0, {27.0, 34.0}}, StatedCompliance{1.0, {0.9, 1.1}}, StatedCompliance{2.0, {1.9, 2.1}}};
  const auto changes = comparison::statedChanges(before, after);
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_DOUBLE_EQ(changes[0]->difference.value, 20.0);
  EXPECT_DOUBLE_EQ(changes[0]->difference.expanded(), 5.0);  // the farther ends, 3 and 4
  EXPECT_TRUE(changes[0]->significant());
  EXPECT_NEAR(changes[1]->p_value, 1.0, 1e-12);
  EXPECT_FALSE(changes[1]->significant());
  EXPECT_FALSE(changes[2].has_value());
  // Two are compared: Holm doubles the smaller.
  EXPECT_NEAR(changes[0]->p_holm, 2.0 * changes[0]->p_value, 1e-12);
}

}  // namespace comparison_test
}  // namespace stiffscope
