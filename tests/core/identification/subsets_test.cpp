#include "core/identification/subsets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "core/numerics/resampling.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace subsets_test {

/// Equations with noise, to have subsets that differ.
struct Problem {
  std::vector<identification::CaseEquations> wrist, reflectors;
  identification::SubsetMethod method;

  Problem(int postures, bool decoupled) {
    LinearMachine machine(postures, 1.0, 9);
    Noise noise(10);
    for (identification::LoadCase& one : machine.cases) {
      for (identification::TargetMove& move : one.targets) move.loaded += 1e-4 * noise.normal3();
    }
    wrist = machine.wristEquationsOfAll();
    reflectors = machine.reflectorEquations();
    method.unknown = kAllJoints;
    for (const identification::CaseEquations& one : decoupled ? wrist : reflectors)
      method.normal.push_back(identification::normalEquations(one));
    if (decoupled) {
      for (const identification::CaseEquations& one : reflectors)
        method.reflectors.push_back(identification::normalEquations(one));
    }
    method.at_wrist = identification::DeflectionJudge(wrist);
    method.at_targets = identification::DeflectionJudge(reflectors);
  }
};

std::vector<identification::CaseEquations> chosen(const std::vector<identification::CaseEquations>& all,
                                                  unsigned bits) {
  std::vector<identification::CaseEquations> some;
  for (std::size_t p = 0; p < all.size(); ++p) {
    if (bits >> p & 1U) some.push_back(all[p]);
  }
  return some;
}

/// 1 - sum |residual| / sum |displacement| over the points of the postures whose bit is set, by loops.
double compensated(const std::vector<identification::CaseEquations>& all, unsigned bits, const JointVector& c) {
  double left = 0.0, whole = 0.0;
  for (const identification::CaseEquations& one : chosen(all, bits)) {
    const Eigen::VectorXd rest = one.right - one.matrix * c;
    for (Eigen::Index at = 0; at < rest.size(); at += 3)
      left += rest.segment<3>(at).norm(), whole += one.right.segment<3>(at).norm();
  }
  return 1.0 - left / whole;
}

bool before(const JointVector& a, const JointVector& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

TEST(Subsets, FourOfSevenAreThoseSolvedOneByOne) {
  for (const bool decoupled : {false, true}) {
    const Problem problem(7, decoupled);
    std::vector<JointVector> direct;
    identification::SubsetCompensation sum;
    for (unsigned bits = 0; bits < 1U << 7; ++bits) {
      if (std::popcount(bits) != 4) continue;
      const auto reflectors = chosen(problem.reflectors, bits);
      const JointVector c =
          decoupled
              ? identification::decoupledPartialPose(chosen(problem.wrist, bits), reflectors, kAllJoints).compliance
              : identification::partialPose(reflectors, kAllJoints).compliance;
      direct.push_back(c);
      sum.used += compensated(problem.wrist, bits, c) / 35.0;
      sum.held_out += compensated(problem.wrist, ~bits & 127U, c) / 35.0;
      sum.all += compensated(problem.wrist, 127U, c) / 35.0;
    }
    identification::SubsetOptions options;
    options.size = 4;
    identification::SubsetStudy study = identification::studySubsets(problem.method, options);
    EXPECT_TRUE(study.every_subset);
    EXPECT_EQ(study.of, 7);
    ASSERT_EQ(study.compliances.size(), 35u);
    std::sort(direct.begin(), direct.end(), before);
    std::sort(study.compliances.begin(), study.compliances.end(), before);
    for (std::size_t k = 0; k < direct.size(); ++k) {
      // Sums taken in another order: rounding times the condition squared.
      EXPECT_LT((direct[k] - study.compliances[k]).norm(), 1e-9 * direct[k].norm());
    }
    EXPECT_NEAR(study.at_wrist.compensated.used, sum.used, 1e-10);
    EXPECT_NEAR(study.at_wrist.compensated.held_out, sum.held_out, 1e-10);
    EXPECT_NEAR(study.at_wrist.compensated.all, sum.all, 1e-10);
  }
}

TEST(Subsets, ThePapersTenOfNineteenAreAll92378) {
  const Problem problem(19, true);
  const identification::SubsetStudy study = identification::studySubsets(problem.method);
  EXPECT_EQ(study.size, 10);
  EXPECT_TRUE(study.every_subset);
  EXPECT_EQ(study.compliances.size(), 92378u);
  EXPECT_EQ(numerics::subsetCount(19, 10), 92378u);
  // However the two threads shared the work, a second run gives the same numbers in the same order.
  const identification::SubsetStudy again = identification::studySubsets(problem.method);
  EXPECT_TRUE(std::equal(study.compliances.begin(), study.compliances.end(), again.compliances.begin()));
  EXPECT_EQ(study.at_targets.compensated.held_out, again.at_targets.compensated.held_out);
  // Every posture is drawn equally often, so the mean over the subsets is near the whole's: within the
  // noise's size.
  JointVector mean = JointVector::Zero(6);
  for (const JointVector& one : study.compliances) mean += one / static_cast<double>(study.compliances.size());
  EXPECT_LT(worstError(mean, exampleCompliance()), 0.05);
}

TEST(Subsets, ASampleIsTheSameForTheSameSeed) {
  const Problem problem(14, false);
  identification::SubsetOptions options;
  options.most_all = 100;
  options.sample = 500;
  const identification::SubsetStudy one = identification::studySubsets(problem.method, options),
                                    two = identification::studySubsets(problem.method, options);
  EXPECT_FALSE(one.every_subset);
  ASSERT_EQ(one.compliances.size(), 500u);
  EXPECT_TRUE(std::equal(one.compliances.begin(), one.compliances.end(), two.compliances.begin()));
  options.seed = 2;
  EXPECT_FALSE(std::equal(one.compliances.begin(), one.compliances.end(),
                          identification::studySubsets(problem.method, options).compliances.begin()));
}

TEST(Subsets, ASampleStandsForAllSubsets) {
  for (const bool decoupled : {false, true}) {
    const Problem problem(14, decoupled);
    identification::SubsetOptions options;
    const identification::SubsetStudy all = identification::studySubsets(problem.method, options);
    ASSERT_TRUE(all.every_subset);
    options.most_all = 100;
    options.sample = 2003;  // no whole number of groups
    const identification::SubsetStudy some = identification::studySubsets(problem.method, options);
    ASSERT_EQ(some.compliances.size(), 2003u);
    EXPECT_NEAR(some.at_wrist.compensated.used, all.at_wrist.compensated.used, 2e-3);
    EXPECT_NEAR(some.at_targets.compensated.held_out, all.at_targets.compensated.held_out, 2e-3);
    EXPECT_NEAR(some.at_targets.compensated.all, all.at_targets.compensated.all, 2e-3);
    for (std::size_t p = 0; p < 14; ++p) {
      EXPECT_NEAR(some.at_targets.left_held_out[p] / all.at_targets.left_held_out[p], 1.0, 0.03) << p;
    }
  }
}

TEST(Subsets, OfManyPosturesEachHalfAgreesWithTheWhole) {
  for (const bool decoupled : {false, true}) {
    const Problem problem(500, decoupled);
    const identification::SubsetStudy study = identification::studySubsets(problem.method);
    EXPECT_FALSE(study.every_subset);
    EXPECT_EQ(study.compliances.size(), 4000u);
    const JointVector whole =
        decoupled ? identification::decoupledPartialPose(problem.wrist, problem.reflectors, kAllJoints).compliance
                  : identification::partialPose(problem.reflectors, kAllJoints).compliance;
    for (const JointVector& one : study.compliances) ASSERT_LT(worstError(one, whole), 0.1);
    // One posture more or less hardly changes such a fit: what is left of it, used or not, is what the whole leaves.
    const std::vector<double> left = problem.method.at_targets.residual(whole);
    for (std::size_t p = 0; p < left.size(); ++p) {
      EXPECT_NEAR(study.at_targets.left_held_out[p] / left[p], 1.0, 0.2) << p;
    }
    EXPECT_NEAR(study.at_targets.compensated.all, problem.method.at_targets.compensated(whole), 2e-3);
  }
}

TEST(Subsets, OfAllOrMoreThereIsNothingToStudy) {
  const Problem problem(7, false);
  identification::SubsetOptions options;
  options.size = 7;
  EXPECT_TRUE(identification::studySubsets(problem.method, options).compliances.empty());
  EXPECT_TRUE(identification::studySubsets(identification::SubsetMethod{}).compliances.empty());
}

TEST(SubsetCount, ByHand) {
  EXPECT_EQ(numerics::subsetCount(5, 2), 10u);
  EXPECT_EQ(numerics::subsetCount(7, 7), 1u);
  EXPECT_EQ(numerics::subsetCount(7, 0), 1u);
  EXPECT_EQ(numerics::subsetCount(500, 250), std::numeric_limits<std::uint64_t>::max());
}

TEST(StiffnessSpread, ByHand) {
  // Compliances 1, 2, 4, -4, 5 : stiffnesses 1, 0.5, 0.25, -0.25, 0.2.
  identification::SubsetStudy study;
  for (const double c : {4.0, 1.0, -4.0, 2.0, 5.0}) study.compliances.push_back(JointVector::Constant(6, c));
  const identification::StiffnessSpread spread = identification::spreadOf(study, 2);
  EXPECT_NEAR(spread.mean, 1.7 / 5.0, 1e-15);
  // Squares of 0.66, 0.16, -0.09, -0.59, -0.14 sum to 0.837, over n - 1 = 4.
  EXPECT_NEAR(spread.sd, std::sqrt(0.837 / 4.0), 1e-12);
  EXPECT_DOUBLE_EQ(spread.median, 0.25);
  EXPECT_DOUBLE_EQ(spread.low, -0.25);
  EXPECT_DOUBLE_EQ(spread.high, 1.0);
  EXPECT_DOUBLE_EQ(spread.quartile_low, 0.2);
  EXPECT_DOUBLE_EQ(spread.quartile_high, 0.5);
  EXPECT_DOUBLE_EQ(spread.share_negative, 0.2);
  EXPECT_NEAR(spread.compliance_mean, 1.6, 1e-15);
  EXPECT_NEAR(spread.compliance_sd, std::sqrt((2.4 * 2.4 + 0.36 + 5.6 * 5.6 + 0.16 + 3.4 * 3.4) / 4.0), 1e-12);
}

TEST(DeflectionJudge, ByHand) {
  // Two postures of one and two points; joint 1 moves x by 1 m a unit.
  identification::CaseEquations one{Eigen::Matrix<double, 3, 6>::Zero(), Eigen::Vector3d(3, 4, 0)};
  identification::CaseEquations two{Eigen::Matrix<double, 6, 6>::Zero(),
                                    (Eigen::VectorXd(6) << 0, 0, 2, 1, 0, 0).finished()};
  one.matrix(0, 0) = 1.0;
  two.matrix(3, 0) = 1.0;
  const identification::DeflectionJudge judge({one, two});
  EXPECT_EQ(judge.displacement(), (std::vector<double>{5.0, 3.0}));
  const std::vector<double> left = judge.residual(JointVector::Unit(6, 0));
  EXPECT_NEAR(left[0], std::sqrt(20.0), 1e-15);
  EXPECT_NEAR(left[1], 2.0, 1e-15);
  EXPECT_NEAR(judge.compensated(JointVector::Unit(6, 0)), 1.0 - (std::sqrt(20.0) + 2.0) / 8.0, 1e-15);
  EXPECT_EQ(judge.pointsOf(1), 2);
}

TEST(DeflectionJudge, PointByPointOverManyPostures) {
  const Problem problem(43, false);
  const identification::DeflectionJudge& judge = problem.method.at_targets;
  ASSERT_EQ(judge.postures(), 43u);
  const JointVector c = 1.1 * exampleCompliance();
  const std::vector<double> left = judge.residual(c);
  for (std::size_t p = 0; p < left.size(); ++p) {
    const Eigen::VectorXd rest = problem.reflectors[p].right - problem.reflectors[p].matrix * c;
    double sum = 0.0;
    for (Eigen::Index at = 0; at < rest.size(); at += 3) sum += rest.segment<3>(at).norm();
    EXPECT_NEAR(left[p], sum, 1e-14) << p;
  }
}

}  // namespace subsets_test
}  // namespace stiffscope
