#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "core/simulation/measure.h"
#include "reports/words/compensation_words.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/extended_day.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace certainty_test {

TEST(PredictionSpread, OfNormalErrorsIsTheirs) {
  Noise noise(3);
  Eigen::MatrixX3d errors(20000, 3);
  for (double& one : errors.reshaped()) one = 2.0 * noise.normal();
  const compensation::PredictionSpread spread = compensation::spreadOf(errors);
  // A 2.5 % quantile of 20000 numbers is known to 0.019 standard deviations; four of these.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(spread.interval[k].low, -2.0 * 1.95996, 2.0 * 0.08);
    EXPECT_NEAR(spread.interval[k].high, 2.0 * 1.95996, 2.0 * 0.08);
    EXPECT_NEAR(spread.sd[static_cast<Eigen::Index>(k)], 2.0, 0.04);
  }
  EXPECT_NEAR(spread.expanded, 2.0 * 2.7955, 2.0 * 0.06);  // of chi with three degrees of freedom
  errors(7, 1) = std::nan("");
  EXPECT_TRUE(std::isnan(compensation::spreadOf(errors).expanded));
}

// By sorting all of them. Most of the last ones are nothing, and a few so large that no other is beyond their root mean
// square; of the shifted ones all are on one side of zero.
TEST(PredictionSpread, IntervalsAreByRankHoweverErrorsAreSpread) {
  Noise noise(9);
  const auto expectRanked = [](const Eigen::VectorXd& errors) {
    Eigen::VectorXd sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    const auto rankOf = [&](double share) {
      return static_cast<Eigen::Index>(share * static_cast<double>(errors.size() - 1) + 0.5);
    };
    const identification::CoverageInterval interval = compensation::intervalOf(errors);
    EXPECT_EQ(interval.low, std::min(0.0, sorted[rankOf(0.025)]));
    EXPECT_EQ(interval.high, std::max(0.0, sorted[rankOf(0.975)]));
  };
  Eigen::VectorXd errors(3000);
  for (double& one : errors) one = noise.normal();
  expectRanked(errors);
  expectRanked(errors.array() + 5.0);
  errors.head(30).array() *= 1e6;
  expectRanked(errors);
  expectRanked(Eigen::VectorXd::Constant(7, -2.0));
}

// Five draws of two parameters' numbers, the last one of springs alone.
TEST(DeflectionDraws, TakeTheirParametersInTurn) {
  compensation::DeflectionDraws draws;
  draws.compliance.setZero(6, 5);
  draws.parameters.resize(1, 2);
  draws.parameters << 10.0, 20.0;
  draws.springs_alone = 1;
  Eigen::MatrixXd errors = Eigen::MatrixXd::Constant(5, 2, 1.0);
  draws.addByParameters(Eigen::Vector2d(1.0, -3.0), errors);
  Eigen::MatrixXd expected(5, 2);
  expected << 11, -29, 21, -59, 11, -29, 21, -59, 1, 1;
  EXPECT_EQ(errors, expected);
}

/// A known arm, what its day is said to have had, and one posture.
struct KnownDay : KnownArm {
  compensation::Certainty certainty{{}, compensation::IdentifiedRange(6)};
  JointVector q = degrees(20, 10, -20, 50, 60, -30);

  KnownDay() {
    certainty.draws = compensation::springDraws(estimate, estimate.covariance);
    certainty.range.force = 1500.0;
    certainty.range.moment = 1e9;
    certainty.range.torque.setConstant(1e9);
    certainty.range.low = q.array() - 0.5;
    certainty.range.high = q.array() + 0.5;
  }

  compensation::CompensatedPosture run(const JointVector& at, const Eigen::Vector3d& force) const {
    const compensation::PostureToCompensate asked{"a", at, lab.cellReading(lab.settled(at), force)};
    return compensation::compensate(campaign, geometry, estimate, Eigen::Vector3d::Zero(), {asked}, {}, nullptr,
                                    &certainty)
        .front();
  }
};

TEST(Certainty, LoadsBeyondTheDaysAreCautionedOfAndThenRefused) {
  const KnownDay day;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const compensation::CompensatedPosture usual = day.run(day.q, 1400.0 * down), more = day.run(day.q, 3000.0 * down),
                                         far = day.run(day.q, 20.0 * 1500.0 * down);
  ASSERT_TRUE(usual.solved) << reports::words(usual.reason);
  EXPECT_TRUE(usual.cautions.empty());
  EXPECT_NEAR(usual.load_ratio, 1400.0 / 1500.0, 1e-9);
  ASSERT_TRUE(more.solved) << reports::words(more.reason);
  ASSERT_EQ(more.cautions.size(), 1u);
  EXPECT_TRUE(more.cautions[0].is(compensation::RemarkId::load_beyond));
  EXPECT_FALSE(far.solved);
  EXPECT_TRUE(far.predicted);
  EXPECT_TRUE(far.reason.is(compensation::RemarkId::load_far_beyond)) << reports::words(far.reason);
  const compensation::CompensationSummary summary = compensation::summaryOf({usual, more, far});
  EXPECT_FALSE(summary.mostRefused());
  EXPECT_EQ(
      reports::summaryWords(summary),
      "2 of 3 postures compensated, 1 of them with cautions; 1 refused: 1 because the load is far beyond those that "
      "the stiffnesses come from");
  EXPECT_TRUE(compensation::summaryOf({usual, far, far}).mostRefused());
}

TEST(Certainty, PosturesFarFromTheDaysAreCautionedOfAndThenRefused) {
  KnownDay day;
  const Eigen::Vector3d force(0.0, 0.0, -1000.0);
  day.certainty.range.low[2] = day.q[2] + 0.5;
  day.certainty.range.high[2] = day.q[2] + 0.9;
  const compensation::CompensatedPosture outside = day.run(day.q, force);
  ASSERT_TRUE(outside.solved) << reports::words(outside.reason);
  ASSERT_EQ(outside.cautions.size(), 1u);
  EXPECT_TRUE(outside.cautions[0].is(compensation::RemarkId::posture_beyond));
  day.certainty.range.low[2] = day.q[2] + 1.7;
  day.certainty.range.high[2] = day.q[2] + 1.9;
  EXPECT_TRUE(day.run(day.q, force).reason.is(compensation::RemarkId::posture_far_beyond));
  // A whole turn is none.
  day.certainty.range.low[2] = day.q[2] - 0.1 + 2.0 * EIGEN_PI;
  day.certainty.range.high[2] = day.q[2] + 0.1 + 2.0 * EIGEN_PI;
  EXPECT_TRUE(day.run(day.q, force).cautions.empty());
}

// A base that gives along x by an unknown 0 +- 1 um/N: a vertical load does not rouse it, a horizontal one does.
TEST(Certainty, WhatTheDayCouldNotSeeWidensTheDirectionThatRousesIt) {
  KnownDay day;
  Noise noise(5);
  day.certainty.draws.parameters.resize(1, day.certainty.draws.size());
  for (double& one : day.certainty.draws.parameters.reshaped()) one = 1e-6 * noise.normal();
  day.certainty.draws.by = [](const JointVector&, const effects::FlangeLoad& load,
                              const std::vector<Eigen::Vector3d>& points) {
    Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(points.size()), 1);
    for (Eigen::Index row = 0; row < by.rows(); row += 3) by(row, 0) = load.force.x();
    return by;
  };
  KnownDay blind;  // the same day without that base
  const Eigen::Vector3d down(0.0, 0.0, -1000.0), along(1000.0, 0.0, 0.0);
  // The flange's axes, in which the wrench is read, turn by a hundredth of a degree under load.
  EXPECT_NEAR(day.run(day.q, down).tcp.sd.x(), blind.run(day.q, down).tcp.sd.x(), 1e-5);
  const double sd = day.run(day.q, along).tcp.sd.x(), without = blind.run(day.q, along).tcp.sd.x();
  // A standard deviation of 3000 draws is known to 1.3 %; four of these.
  EXPECT_NEAR(std::sqrt(sd * sd - without * without), 1e-3, 0.06 * 1e-3);
  const compensation::CompensatedPosture refused = day.run(day.q, along);
  EXPECT_NEAR(day.run(day.q, along).rotation_sd.norm(), blind.run(day.q, along).rotation_sd.norm(), 1e-12);
  if (refused.tcp.deflection.norm() < refused.tcp.expanded) {
    EXPECT_TRUE(refused.reason.is(compensation::RemarkId::uncertain_as_itself)) << reports::words(refused.reason);
  }
}

TEST(Certainty, ModelErrorGrowsWithTheLoad) {
  KnownDay day;
  day.estimate.covariance.setZero();
  day.certainty.draws = compensation::springDraws(day.estimate, JointMatrix::Zero(6, 6));
  day.certainty.range.model_error = 50e-6;
  const compensation::CompensatedPosture half = day.run(day.q, {0.0, 0.0, -750.0}),
                                         whole = day.run(day.q, {0.0, 0.0, -1500.0});
  EXPECT_NEAR(whole.tcp.sd.z(), 50e-6, 1e-12);
  EXPECT_NEAR(half.tcp.sd.z(), 25e-6, 1e-9);
  EXPECT_NEAR(whole.targets[0].expanded, 50e-6 * 2.7955, 50e-6 * 0.15);  // chi of three, of 3000 draws
}

TEST(Certainty, AScaleOfTheLoadCellIsInThePrediction) {
  KnownDay day;
  day.certainty.draws = compensation::springDraws(day.estimate, JointMatrix::Zero(6, 6), 0.02);
  const compensation::CompensatedPosture found = day.run(day.q, {0.0, 0.0, -1500.0});
  EXPECT_LT((found.tcp.sd - 0.02 * found.tcp.deflection.cwiseAbs()).norm(), 1e-12);
}

// Held-out residuals beyond noise: none of an arm of springs, some of one whose bearing tilts.
TEST(IdentifiedRange, IsThatOfTheDay) {
  simulation::SimulationSpec spec = springsAlone(3);
  const campaign::Campaign plain = simulation::simulate(spec);
  const identification::Identification springs = identification::identify(plain, fewSubsets(2));
  spec.machine.joints[2].bearing = 4e6;
  const identification::Identification tilts = identification::identify(simulation::simulate(spec), fewSubsets(2));
  for (const identification::Method method : identification::kMethods) {
    const compensation::IdentifiedRange range = compensation::identifiedRange(springs, method);
    double force = 0.0;
    for (const campaign::State& state : plain.states->rows)
      force = std::max(force, state.wrench_in_cell.head<3>().norm());
    EXPECT_NEAR(range.force, force, 1e-6 * force);
    for (const identification::LoadCase& one : springs.cases) {
      EXPECT_LE(compensation::loadRatio(range, one.wrench, one.axes), 1.0 + 1e-12);
      EXPECT_TRUE((one.q.array() >= range.low.array()).all() && (one.q.array() <= range.high.array()).all());
    }
    EXPECT_LT(range.model_error, springs.noise->per_coordinate);
    const double left = compensation::identifiedRange(tilts, method).model_error;
    EXPECT_GT(left, 3.0 * tilts.noise->per_coordinate);
    // Left out, a posture is missed by more than the fit leaves of it, and not by several times as much.
    EXPECT_GT(left, 0.7 * tilts.of(method).estimate.rms_residual);
    EXPECT_LT(left, 4.0 * tilts.of(method).estimate.rms_residual);
  }
}

}  // namespace certainty_test
}  // namespace stiffscope
