#include "core/comparison/paired_days.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace paired_days_test {

using calibration::UnloadedDay;

/// Postures by their ids, each read at some of the day's reflectors.
struct Read {
  std::string pose;
  double q1 = 0.0;
  std::vector<int> targets;
};

UnloadedDay dayOf(std::vector<std::string> targets, const std::vector<Read>& postures) {
  UnloadedDay day;
  day.targets = std::move(targets);
  for (const Read& one : postures) {
    calibration::Posture posture(6);
    posture.pose = static_cast<int>(day.pose_ids.size());
    posture.q[0] = one.q1;
    for (const int target : one.targets) posture.readings.push_back({target});
    day.pose_ids.push_back(one.pose);
    day.postures.push_back(std::move(posture));
  }
  return day;
}

TEST(CommonReadings, AreOfOnePoseOneShapeAndOneReflector) {
  // Reflectors A, B and B, C, A. Pose 2 is another shape the day after, pose 4 was not measured again; in pose 1 B was
  // not read again.
  const UnloadedDay before =
      dayOf({"A", "B"}, {{"1", 0.1, {0, 1}}, {"2", 0.2, {0}}, {"3", 0.3, {1, 0}}, {"4", 0, {0}}});
  const UnloadedDay after =
      dayOf({"B", "C", "A"}, {{"3", 0.3 + 1e-4, {0, 1, 2}}, {"2", 0.2 + 1e-3, {2}}, {"1", 0.1, {2}}});
  const comparison::CommonReadings common = comparison::commonReadings(before, after);
  EXPECT_EQ(common.targets[0], (std::vector<int>{0, 1}));
  EXPECT_EQ(common.targets[1], (std::vector<int>{2, 0}));
  EXPECT_EQ(common.postures, 2u);
  // In the order of the day before: pose 1's A; pose 3's B, then A. Readings by their places in the whole day.
  const std::vector<std::array<std::size_t, 4>> expected{{0, 0, 2, 4}, {2, 3, 0, 0}, {2, 4, 0, 2}};
  ASSERT_EQ(common.readings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const comparison::CommonReading& one = common.readings[i];
    EXPECT_EQ(
        (std::array<std::size_t, 4>{one.before.posture, one.before.reading, one.after.posture, one.after.reading}),
        expected[i])
        << i;
  }
}

comparison::PairedDays paired(const campaign::Campaign& before, const campaign::Campaign& after) {
  return comparison::PairedDays({calibration::calibrate(before, {}), calibration::calibrate(after, {})});
}

// A day measured again with a misfit that recurs: on the same postures the covariance is by the 20 um of noise, which
// the difference of the residuals leaves; on other postures by noise and misfit.
TEST(PairedDays, TheCovarianceIsByWhatRecursOnlyWherePosturesDiffer) {
  Noise noise(12);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.joint_errors = [](const JointVector& q) {
    JointVector errors = JointVector::Zero(6);
    for (Eigen::Index j = 0; j < 6; ++j)
      errors[j] = 100e-6 * std::sin((3.3 + static_cast<double>(j)) * q[j]) * std::cos(2.1 * q[(j + 1) % 6]);
    return errors;
  };
  const campaign::Campaign before = unloadedCampaign(spec, noise);
  const comparison::PairedDays same = paired(before, measuredAgain(before, spec, noise)),
                               apart = paired(before, unloadedCampaign(spec, noise));
  EXPECT_TRUE(same.same_postures);
  EXPECT_EQ(same.postures_common, 60u);
  EXPECT_EQ(same.rows[0], 3.0 * 180.0);
  EXPECT_FALSE(apart.same_postures);
  EXPECT_EQ(apart.postures_common, 0u);
  EXPECT_GT(same.left[0], 3.0 * std::sqrt(3.0) * 20e-6);  // the misfit is in both fits
  // Axis parameters of both fits stand first among their unknowns; a fivefold misfit is a fivefold standard deviation.
  double ratio = 0.0;
  constexpr Eigen::Index kAxes = 15;
  for (Eigen::Index k = 0; k < kAxes; ++k)
    ratio += std::log(apart.covariances[0](k, k) / same.covariances[0](k, k)) / (2.0 * kAxes);
  EXPECT_GT(std::exp(ratio), 2.0);
}

/// Covariance of a day's unknowns by errors of single coordinates of this variance (m^2) alone.
Eigen::MatrixXd byCoordinates(const comparison::PairedDays& pair, std::size_t k, double variance, double declared) {
  comparison::ErrorComponents errors(6);
  errors.coordinate = variance / (declared + pair.fits[k].model_sd * pair.fits[k].model_sd);
  return comparison::covarianceBy(comparison::FitEquations(pair.day(k), pair.fits[k]), errors);
}

// Joints that stand anew in each posture, by ten times what the tracker's noise is at the reflectors: whatever the
// scatter of the joints hides, no unknown is better known than the tracker has it.
TEST(PairedDays, TheTrackersNoiseIsNotLostBesideJointsThatScatter) {
  for (std::uint64_t seed = 21; seed < 25; ++seed) {
    Noise noise(seed);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.joint_errors = [&noise](const JointVector& q) {
      JointVector errors(q.size());
      for (double& one : errors) one = 100e-6 * noise.normal();
      return errors;
    };
    const campaign::Campaign before = unloadedCampaign(spec, noise);
    const comparison::PairedDays pair = paired(before, unloadedCampaign(spec, noise));
    ASSERT_FALSE(pair.same_postures);
    for (std::size_t k = 0; k < 2; ++k) {
      const double declared = spec.noise * spec.noise;
      const Eigen::MatrixXd least = byCoordinates(pair, k, declared, declared);
      // In parts of the least, unknown by unknown combined in any way: one or more.
      const Eigen::VectorXd ratios =
          Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(pair.covariances[k], least).eigenvalues();
      EXPECT_GT(ratios.minCoeff(), 0.999) << seed;
      EXPECT_LT(ratios.minCoeff(), 1.5) << seed;  // some combinations are free of what joints do
    }
  }
}

// The day after by a tracker of a third of the noise: of the difference, noise of both, each day has half.
TEST(PairedDays, NoiseOfTheDifferenceIsSharedByBothDays) {
  Noise noise(26);
  UnloadedSpec spec = builtOtherwise(noise);
  const campaign::Campaign before = unloadedCampaign(spec, noise);
  const double coarse = spec.noise * spec.noise;
  spec.noise /= 3.0;
  const double fine = spec.noise * spec.noise;
  campaign::Campaign after = measuredAgain(before, spec, noise);
  after.tracker->range_fixed = after.tracker->angle_fixed = spec.noise;
  const comparison::PairedDays pair = paired(before, after);
  ASSERT_TRUE(pair.same_postures);
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::MatrixXd expected = byCoordinates(pair, k, 0.5 * (coarse + fine), k == 0 ? coarse : fine);
    const Eigen::VectorXd ratios = pair.covariances[k].diagonal().cwiseQuotient(expected.diagonal());
    EXPECT_GT(ratios.minCoeff(), 0.999) << k;
    EXPECT_LT(ratios.mean(), 1.3) << k;  // by the noise of the day before alone: 1.8 of that day
  }
}

}  // namespace paired_days_test
}  // namespace stiffscope
