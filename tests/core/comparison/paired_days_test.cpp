#include "core/comparison/paired_days.h"

#include <gtest/gtest.h>

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

}  // namespace paired_days_test
}  // namespace stiffscope
