#include "core/calibration/position_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/calibration/calibrate.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace position_errors_test {

using calibration::CalibratedModel;

calibration::Calibration calibrated(std::uint64_t seed, const std::function<void(campaign::Campaign&)>& spoil = {}) {
  Noise noise(seed);
  campaign::Campaign campaign = unloadedCampaign(builtOtherwise(noise), noise);
  if (spoil) spoil(campaign);
  return calibration::calibrate(campaign, {});
}

TEST(PositionErrors, AreThoseOfTheHeldOutFigures) {
  const calibration::Calibration day = calibrated(41);
  const auto errors = calibration::readingErrors(day);
  ASSERT_EQ(errors.size(), day.day.readings());
  for (const CalibratedModel model : {CalibratedModel::nominal, CalibratedModel::geometry}) {
    const std::vector<double> lengths = calibration::errorLengths(errors, model);
    ASSERT_EQ(lengths.size(), errors.size());
    double sum = 0.0;
    for (const double length : lengths) sum += length * length;
    const auto& held_out = day.of(model).held_out;
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(lengths.size())), held_out.rms, 1e-12);  // rounding
    EXPECT_NEAR(lengths.back(), held_out.largest, 1e-12);
    EXPECT_TRUE(std::is_sorted(lengths.begin(), lengths.end()));
  }
}

TEST(PositionErrors, LeaveOutWhatIsRejected) {
  const calibration::Calibration day =
      calibrated(42, [](campaign::Campaign& campaign) { campaign.loading->rows[7].point.x() += 0.3; });
  ASSERT_EQ(day.rejected.size(), 1u);
  const auto errors = calibration::readingErrors(day);
  EXPECT_EQ(errors.size() + 1, day.day.readings());
  EXPECT_LT(calibration::errorLengths(errors, CalibratedModel::geometry).back(), 1e-3);
}

TEST(PositionErrors, TheWorstPosturesComeFirstAndOnce) {
  const calibration::Calibration day = calibrated(43);
  const auto errors = calibration::readingErrors(day);
  const auto worst = calibration::worstPostures(errors, CalibratedModel::geometry, 10);
  ASSERT_EQ(worst.size(), 10u);
  EXPECT_DOUBLE_EQ(worst.front().of(CalibratedModel::geometry).norm(),
                   calibration::errorLengths(errors, CalibratedModel::geometry).back());
  for (std::size_t i = 1; i < worst.size(); ++i) {
    EXPECT_LE(worst[i].of(CalibratedModel::geometry).norm(), worst[i - 1].of(CalibratedModel::geometry).norm());
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(worst[i].posture, worst[k].posture);
  }
}

TEST(PositionErrors, NoneWithoutACalibration) {
  EXPECT_TRUE(calibration::readingErrors(calibration::calibrate(campaign::Campaign(), {})).empty());
}

/// Of an arm that is as its URDF says; five standard uncertainties of a dozen numbers leave a chance of 1e-5.
TEST(FrameUncertainty, StationTurnAndReflectorsAreWithinTheirUncertainties) {
  Noise noise(44);
  const UnloadedSpec spec;
  const calibration::Calibration day = calibration::calibrate(unloadedCampaign(spec, noise), {});
  const calibration::ArmFit& fit = day.of(CalibratedModel::nominal).fit;
  const Eigen::Isometry3d base_from_tracker = spec.tracker_from_base.inverse();
  const calibration::UncertainPoint station = calibration::stationInBase(day.day, fit);
  const calibration::UncertainPoint turn = calibration::turnOfStation(fit);
  const Eigen::AngleAxisd true_turn(base_from_tracker.linear());
  const Eigen::AngleAxisd off(Eigen::AngleAxisd(turn.value.norm(), turn.value.normalized()).toRotationMatrix() *
                              true_turn.inverse().toRotationMatrix());
  const std::vector<calibration::UncertainPoint> targets = calibration::targetsInFlange(day.day, fit);
  ASSERT_EQ(targets.size(), spec.on_flange.size());
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(station.sd[k], 0.0);
    EXPECT_LT(std::abs(station.value[k] - base_from_tracker.translation()[k]), 5.0 * station.sd[k]);
    EXPECT_LT(std::abs(off.angle() * off.axis()[k]), 5.0 * turn.sd[k]);
    for (std::size_t t = 0; t < targets.size(); ++t)
      EXPECT_LT(std::abs(targets[t].value[k] - spec.on_flange[t][k]), 5.0 * targets[t].sd[k]) << t;
  }
}

}  // namespace position_errors_test
}  // namespace stiffscope
