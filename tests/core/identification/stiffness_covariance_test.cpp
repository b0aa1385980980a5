#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include "core/identification/estimate.h"
#include "core/identification/identify.h"
#include "core/identification/load_dependence.h"
#include "core/identification/method_runs.h"
#include "core/identification/method_solution.h"
#include "core/identification/remarks.h"
#include "core/identification/subsets.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/on_one_core.h"

namespace stiffscope {
namespace stiffness_covariance_test {

const robot::JointMask kFirstOnly{true, false, false, false, false, false};

/// b_p measured n times of one unknown: the mean, whose variance and degrees of freedom are in every book.
std::vector<identification::CaseEquations> repeatedMeasurement(const std::vector<double>& values) {
  std::vector<identification::CaseEquations> equations;
  for (const double value : values) {
    identification::CaseEquations one;
    one.matrix = Eigen::Matrix<double, 1, 6>::Zero();
    one.matrix(0, 0) = 1.0;
    one.right = Eigen::VectorXd::Constant(1, value);
    equations.push_back(one);
  }
  return equations;
}

identification::StiffnessEstimate meanOf(const std::vector<double>& values) {
  const auto equations = repeatedMeasurement(values);
  identification::NormalEquations sum;
  for (const identification::CaseEquations& one : equations) sum += identification::normalEquations(one);
  identification::StiffnessEstimate estimate(6);
  estimate.identifiable = kFirstOnly;
  estimate.compliance = identification::solveNormal(sum, kFirstOnly);
  identification::setScatterOfOneStage(identification::normalByPosture(equations), sum, estimate);
  return estimate;
}

TEST(StiffnessCovariance, OfAMeanIsTheBooks) {
  const identification::StiffnessEstimate estimate = meanOf({1.0, 2.0, 4.0, 7.0, 11.0});  // mean 5, sum of squares 66
  EXPECT_NEAR(estimate.covariance(0, 0), 66.0 / (5.0 * 4.0), 1e-12);                      // rounding
  EXPECT_NEAR(estimate.dof(0), 4.0, 1e-6);                                                // bisection
  const identification::CoverageInterval interval = identification::complianceInterval(estimate, 0);
  EXPECT_NEAR(interval.high - 5.0, 2.776445105 * std::sqrt(3.3), 1e-6);  // Student's t, 4 degrees, tables
  EXPECT_NEAR(interval.low + interval.high, 10.0, 1e-12);
}

TEST(StiffnessCovariance, StepsOfAPostureCountOnce) {
  // Every posture twice with the same error: as many equations, no more knowledge.
  auto equations = repeatedMeasurement({1.0, 2.0, 4.0, 7.0, 11.0});
  std::vector<identification::CaseEquations> doubled;
  for (std::size_t p = 0; p < equations.size(); ++p) {
    equations[p].posture = static_cast<int>(p);
    doubled.push_back(equations[p]);
    doubled.push_back(equations[p]);
  }
  const std::vector<identification::CaseEquations> joined = identification::byPosture(doubled);
  ASSERT_EQ(joined.size(), 5u);
  identification::NormalEquations sum;
  for (const identification::CaseEquations& one : joined) sum += identification::normalEquations(one);
  identification::StiffnessEstimate estimate(6);
  estimate.identifiable = kFirstOnly;
  estimate.compliance = identification::solveNormal(sum, kFirstOnly);
  identification::setScatterOfOneStage(identification::normalByPosture(doubled), sum, estimate);
  EXPECT_NEAR(estimate.covariance(0, 0), 3.3, 1e-12);
  EXPECT_NEAR(estimate.dof(0), 4.0, 1e-6);
}

TEST(StiffnessCovariance, SharedPartsRaiseTheDegreesOfFreedom) {
  identification::StiffnessEstimate estimate = meanOf({1.0, 2.0, 4.0, 7.0, 11.0});
  estimate.parts.frames(0, 0) = estimate.parts.scatter(0, 0);  // as large again, and known
  estimate.covariance = estimate.parts.total();
  EXPECT_NEAR(estimate.dof(0), 16.0, 1e-5);  // (2 V)^2 / (V^2 / 4)
}

TEST(CoverageFactor, IsStudentsForEqualWeightsAndMonteCarlosForOthers) {
  for (const int dof : {3, 6, 15}) {
    // Midpoint rule of 32 nodes against the incomplete beta function.
    EXPECT_NEAR(
        identification::coverageFactor(Eigen::VectorXd::Ones(dof), 0.95) / identification::studentFactor(dof, 0.95),
        1.0, 1e-3)
        << dof;
    EXPECT_NEAR(identification::matchedDof(Eigen::MatrixXd::Identity(dof, dof)), dof, 1e-3 * dof);
  }
  EXPECT_NEAR(identification::studentFactor(1.0, 0.95), 12.7062, 1e-3);  // tables
  EXPECT_NEAR(identification::studentFactor(4.0, 0.95), 2.776445, 1e-5);
  // One posture makes 60 % of the scatter: 2.7 degrees by Satterthwaite, whose factor would hold the truth in 98.4 %
  // (400,000 draws in numpy).
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(16, 0.4 / 15.0);
  weights[0] = 0.6;
  const double factor = identification::coverageFactor(weights, 0.95);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 100'000;
  int held = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    double variance = 0.0;
    for (const double weight : weights) {
      const double one = normal(random);
      variance += weight * one * one;
    }
    held += std::abs(normal(random)) <= factor * std::sqrt(variance);
  }
  // Five standard deviations of a binomial of 100,000: 0.0035.
  EXPECT_NEAR(static_cast<double>(held) / kDraws, 0.95, 0.0035);
}

/// Two hundred postures that share six parameters; `heavy` of them count forty times as much as the rest.
identification::InfluenceCovariance manyPostures(int heavy) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  constexpr int kPostures = 200;
  identification::InfluenceCovariance covariance{Eigen::VectorXd(kPostures), Eigen::MatrixXd(6, kPostures),
                                                 JointMatrix::Zero(6, 6)};
  for (int p = 0; p < kPostures; ++p) {
    const double size = p % (kPostures / heavy) == 0 ? 6.0 : 1.0;
    const JointVector row = size * JointVector::NullaryExpr(6, [&] { return normal(random); });
    covariance.own[p] = row.squaredNorm();
    covariance.through.col(p) = row.squaredNorm() * row;
  }
  // What a fit of six parameters takes away: no posture's variance becomes negative.
  covariance.middle =
      -(covariance.through * covariance.own.cwiseInverse().asDiagonal() * covariance.through.transpose()).inverse();
  return covariance;
}

TEST(InfluenceCovariance, IsTheDenseMatrixWithoutItsEntries) {
  const identification::InfluenceCovariance covariance = manyPostures(4);
  std::vector<Eigen::Index> all(200);
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  const Eigen::MatrixXd dense = covariance.between(all);
  // Rounding of sums of 200 terms.
  EXPECT_NEAR(covariance.trace() / dense.trace(), 1.0, 1e-12);
  EXPECT_NEAR(covariance.squaredNorm() / dense.squaredNorm(), 1.0, 1e-12);
  const identification::InfluenceCovariance sum = identification::combined(2.0, covariance, 3.0, covariance);
  EXPECT_NEAR((sum.between(all) - 5.0 * dense).norm() / dense.norm(), 0.0, 1e-12);
}

TEST(InfluenceCovariance, DegreesOfFreedomOfManyPosturesAreThoseOfAllEigenvalues) {
  for (const int heavy : {1, 4, 20, 100}) {
    const identification::InfluenceCovariance covariance = manyPostures(heavy);
    std::vector<Eigen::Index> all(200);
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    const double exact = identification::matchedDof(covariance.between(all));
    // 2 % of the degrees are below 0.5 % of the factor from four degrees on.
    EXPECT_NEAR(identification::matchedDof(covariance) / exact, 1.0, 0.02) << heavy << " heavy, " << exact;
  }
}

TEST(StiffnessInterval, IsOpenWhereTheComplianceMayBeZero) {
  const identification::CoverageInterval both =
      identification::stiffnessInterval(identification::CoverageInterval{0.25, 0.5});
  EXPECT_DOUBLE_EQ(both.low, 2.0);
  EXPECT_DOUBLE_EQ(both.high, 4.0);
  const identification::CoverageInterval open =
      identification::stiffnessInterval(identification::CoverageInterval{-0.1, 0.5});
  EXPECT_DOUBLE_EQ(open.low, 2.0);
  EXPECT_TRUE(std::isinf(open.high));
  EXPECT_TRUE(open.holds(1e9));
  const identification::CoverageInterval negative =
      identification::stiffnessInterval(identification::CoverageInterval{-0.5, -0.25});
  EXPECT_DOUBLE_EQ(negative.low, -4.0);
  EXPECT_DOUBLE_EQ(negative.high, -2.0);
}

simulation::SimulationSpec springsOnly() {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  return spec;
}

identification::IdentifyOptions quick() {
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = 1;
  return options;
}

TEST(StiffnessCovariance, SharedPartsByAThousandPosturesAreThoseOfAll) {
  simulation::SimulationSpec spec = springsOnly();
  spec.posture_draw->count = 3000;
  spec.posture_draw->candidates = 1;
  const campaign::Campaign campaign = simulation::simulate(spec);
  const identification::Identification found = identification::identify(campaign, quick());
  const identification::MethodResult& method = found.of(identification::Method::decoupled_partial_pose);
  identification::MethodSolution how;
  how.method = identification::Method::decoupled_partial_pose;
  how.unknown = method.estimate.identifiable;
  const identification::SweptParts all =
      identification::sweptParts(campaign, found.frames, method.geometry, found.steps,
                                 {[&](const identification::LoadedArm& arm) { return how.compliance(arm); }})
          .front();
  const identification::CovarianceParts& some = method.estimate.parts;
  for (int j = 1; j < 6; ++j) {  // the load hangs: no first joint
    // A derivative by n postures scatters by one over the root of n of its own scatter between postures, which is its
    // own size: 3 % of a standard uncertainty by a thousand. Three times that.
    EXPECT_NEAR(std::sqrt((some.frames(j, j) + some.wrist(j, j)) / (all.frames(j, j) + all.wrist(j, j))), 1.0, 0.1)
        << j;
    EXPECT_NE(some.frames(j, j), all.frames(j, j)) << "the bound does not apply";
  }
}

TEST(StiffnessCovariance, OfTheSweepsIsWhatNoisySweepsScatter) {
  // One noiseless loading, and the sweeps of one noisy measurement after the other: what scatters is frames and wrist.
  simulation::SimulationSpec spec = springsOnly();
  spec.tracker.true_noise_factor = 0.0;
  campaign::Campaign campaign = simulation::simulate(spec);
  spec.tracker.true_noise_factor = 1.0;
  constexpr int kDays = 40;
  const std::array<identification::Method, 2> swept{identification::Method::complete_pose,
                                                    identification::Method::decoupled_partial_pose};
  std::array<JointVector, 2> sum{JointVector::Zero(6), JointVector::Zero(6)}, squares = sum, stated = sum;
  for (int day = 0; day < kDays; ++day) {
    spec.measurement = 100 + static_cast<std::uint64_t>(day);
    const campaign::Campaign noisy = simulation::simulate(spec);
    campaign.circle_sweeps = noisy.circle_sweeps;
    campaign.wrist_sweep = noisy.wrist_sweep;
    const identification::Identification found = identification::identify(campaign, quick());
    for (std::size_t m = 0; m < 2; ++m) {
      const identification::StiffnessEstimate& estimate = found.of(swept[m]).estimate;
      sum[m] += estimate.compliance;
      squares[m] += estimate.compliance.cwiseAbs2();
      stated[m] += (estimate.parts.frames + estimate.parts.wrist).diagonal();
    }
  }
  for (std::size_t m = 0; m < 2; ++m) {
    for (int j = 1; j < 6; ++j) {  // the load hangs: no first joint
      const double mean = sum[m][j] / kDays, variance = (squares[m][j] - kDays * mean * mean) / (kDays - 1);
      // A variance from 40 has a relative standard deviation of sqrt(2/39) = 0.23; four and a half of them, upwards
      // as far on a log scale. Complete Pose's part is overstated by up to two in standard deviation, because the
      // reflectors' places at zero really follow the axes they are turned back about (shared_uncertainty.cpp).
      const double ratio = variance / (stated[m][j] / kDays);
      EXPECT_GT(ratio, 1.0 / (m == 0 ? 4.0 * 2.5 : 2.5)) << m << " k" << j + 1;
      EXPECT_LT(ratio, 2.5) << m << " k" << j + 1;
    }
  }
}

TEST(Bootstrap, DoesNotDependOnThreadsAndAgreesWithTheScatter) {
  const simulation::SimulationSpec spec = springsOnly();
  const campaign::Campaign campaign = simulation::simulate(spec);
  identification::IdentifyOptions options = quick();
  options.bootstrap.draws = 2000;
  const identification::Identification all_cores = identification::identify(campaign, options);
  const OnOneCore alone;
  const identification::Identification one = identification::identify(campaign, options);
  for (const identification::Method method : identification::kMethods) {
    const identification::PostureBootstrap &first = one.of(method).bootstrap, &second = all_cores.of(method).bootstrap;
    ASSERT_EQ(first.compliances.size(), 2000u);
    for (std::size_t i = 0; i < first.compliances.size(); ++i) ASSERT_EQ(first.compliances[i], second.compliances[i]);
    for (int j = 1; j < 6; ++j) {
      const identification::CoverageInterval drawn = first.compliance(j),
                                             stated = identification::complianceInterval(one.of(method).estimate, j);
      // Percentiles of 19 postures are narrower than Student's by t/1.96 and by the fit's pull, 0.7 to 1 together.
      const double ratio = (drawn.high - drawn.low) / (stated.high - stated.low);
      EXPECT_GT(ratio, 0.5) << j;
      EXPECT_LT(ratio, 1.3) << j;
    }
  }
}

TEST(OutlyingPostures, AShiftedReflectorIsFoundAndLeftOutOnRequestOnly) {
  const simulation::SimulationSpec spec = springsOnly();
  const campaign::Campaign campaign = simulation::simulate(spec);
  const identification::Identification clean = identification::identify(campaign, quick());
  EXPECT_TRUE(clean.outlying.empty());
  campaign::Campaign spoilt = campaign;
  for (campaign::LoadingReading& reading : spoilt.loading->rows) {
    if (reading.pose == 7 && reading.step == clean.step) reading.point.x() += 1e-3;
  }
  const identification::Identification found = identification::identify(spoilt, quick());
  ASSERT_EQ(found.outlying.size(), 1u);
  EXPECT_EQ(found.outlying[0].posture, 7);
  EXPECT_EQ(found.cases.size(), 19u);
  const bool said = std::any_of(found.cautions.begin(), found.cautions.end(),
                                [](const Remark& one) { return one.is(identification::RemarkId::outlying_postures); });
  EXPECT_TRUE(said);
  identification::IdentifyOptions robust = quick();
  robust.robust = true;
  const identification::Identification without = identification::identify(spoilt, robust);
  EXPECT_EQ(without.cases.size(), 18u);
  ASSERT_EQ(without.left_out.size(), 1u);
  EXPECT_EQ(without.left_out[0].pose, spoilt.pose_ids[7]);
  EXPECT_TRUE(without.left_out[0].reason.is(identification::RemarkId::disagrees));
  // What is left is a clean day with a posture less: within a few of its own uncertainties of the whole.
  for (const identification::Method method : identification::kMethods) {
    for (int j = 1; j < 6; ++j) {
      const double sd = std::sqrt(clean.of(method).estimate.covariance(j, j));
      EXPECT_LT(std::abs(without.of(method).estimate.compliance[j] - clean.of(method).estimate.compliance[j]),
                3.0 * sd);
    }
  }
}

TEST(ByStep, LinearSpringsStayAndStiffeningOnesAreSeen) {
  simulation::SimulationSpec spec = springsOnly();
  const campaign::Campaign linear = simulation::simulate(spec);
  const identification::Identification of_linear = identification::identify(linear, quick());
  const identification::StepStudy same = identification::studySteps(linear, quick(), of_linear);
  // Joint 5: the arm's own weight, which differs between postures, hardly bends it beforehand as it does joints 2
  // and 3.
  spec.machine.joints[4].cubic = 2e10;  // at 1.7e-3 rad a sixth of the linear torque
  const campaign::Campaign stiffening = simulation::simulate(spec);
  const identification::StepStudy other =
      identification::studySteps(stiffening, quick(), identification::identify(stiffening, quick()));
  for (std::size_t m = 0; m < 3; ++m) {
    ASSERT_EQ(same.methods[m].steps.size(), 3u);
    for (std::size_t j = 1; j < 6; ++j) EXPECT_GT(same.methods[m].joints[j].p_linear, 0.03) << m << j;  // fixed seed
    // On the same day with linear springs none is below 0.03; Complete Pose, whose rotations are noisier, sees it
    // least.
    EXPECT_LT(other.methods[m].joints[4].p_linear, m == 0 ? 0.02 : 1e-3) << m;
    EXPECT_LT(other.methods[m].joints[4].change, 0.0);
  }
}

TEST(AllSteps, AgreeWithTheHeaviestAndKeepThePosturesTogether) {
  const campaign::Campaign campaign = simulation::simulate(springsOnly());
  const identification::Identification heaviest = identification::identify(campaign, quick());
  identification::IdentifyOptions options = quick();
  options.all_steps = true;
  const identification::Identification all = identification::identify(campaign, options);
  EXPECT_EQ(all.steps, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(all.cases.size(), 57u);
  for (const identification::Method method : identification::kMethods) {
    const identification::StiffnessEstimate &one = heaviest.of(method).estimate, &joined = all.of(method).estimate;
    EXPECT_EQ(joined.influences.size(), 19u);
    EXPECT_EQ(all.of(method).subsets.of, 19);
    for (int j = 1; j < 6; ++j) {
      EXPECT_LT(std::abs(joined.compliance[j] - one.compliance[j]), 3.0 * std::sqrt(one.covariance(j, j)));
      // Step 0's error is in all steps: three steps are worth less than three days, and the lighter ones little.
      EXPECT_GT(joined.covariance(j, j), 0.3 * one.covariance(j, j));
    }
  }
}

TEST(Identifiability, AJointThatIsNotSeenDoesNotDisturbTheOthers) {
  simulation::SimulationSpec spec = springsOnly();
  const identification::Identification soft = identification::identify(simulation::simulate(spec), quick());
  spec.machine.joints[0].torsion = 7.0e9;  // a thousand times as stiff
  const identification::Identification stiff = identification::identify(simulation::simulate(spec), quick());
  for (const identification::Method method : identification::kMethods) {
    EXPECT_FALSE(soft.of(method).estimate.identifiable[0]);
    EXPECT_EQ(soft.of(method).estimate.compliance[0], 0.0);
    EXPECT_EQ(soft.of(method).estimate.covariance.row(0).norm(), 0.0);
    for (int j = 1; j < 6; ++j) {
      // The hanging load turns axis 1 by the arm's sag and the base's tilt only, some 1e-3 of the other torques.
      const double ratio = soft.of(method).estimate.compliance[j] / stiff.of(method).estimate.compliance[j];
      EXPECT_NEAR(ratio, 1.0, 1e-3) << j;
    }
  }
}

}  // namespace stiffness_covariance_test
}  // namespace stiffscope
