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

/// The scatter of a hundred days' results is what each states of itself, for a fitted arm, whose flange follows its
/// last axes, and a station that is turned far. A standard deviation of a hundred is known to 7 %.
TEST(FrameUncertainty, IsTheScatterOfDays) {
  constexpr int kDays = 100;
  UnloadedSpec spec;
  spec.tracker_from_base =
      Eigen::Translation3d(3.0, -1.0, 0.5) * Eigen::AngleAxisd(2.6, Eigen::Vector3d(0.2, -0.3, 0.93).normalized());
  spec.postures = 40;
  Noise noise(45);
  std::vector<calibration::UncertainPoint> points[3];
  for (int k = 0; k < kDays; ++k) {
    Noise postures(7);  // the same every day
    const campaign::Campaign exact = unloadedCampaign(
        [&] {
          auto still = spec;
          still.noise = 0.0;
          return still;
        }(),
        postures);
    campaign::Campaign campaign = exact;
    campaign.tracker = campaign::Tracker{"even", spec.noise, 0.0, spec.noise, 0.0, Eigen::Vector3d::Zero()};
    for (campaign::LoadingReading& reading : campaign.loading->rows) reading.point += spec.noise * noise.normal3();
    const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
    const std::vector<double> weights(day.readings(), 1.0);
    calibration::FitOptions options;
    options.robust = false;
    options.weights = weights;
    const calibration::ArmFit fit = calibration::fitArm(day, *calibration::placeArm(day, weights), {}, options);
    ASSERT_TRUE(fit.done);
    points[0].push_back(calibration::stationInBase(day, fit));
    points[1].push_back(calibration::turnOfStation(fit));
    points[2].push_back(calibration::targetsInFlange(day, fit).front());
  }
  for (int kind = 0; kind < 3; ++kind) {
    for (int axis = 0; axis < 3; ++axis) {
      double mean = 0.0, squares = 0.0, stated = 0.0;
      for (const calibration::UncertainPoint& one : points[kind]) {
        mean += one.value[axis] / kDays;
        stated += one.sd[axis] * one.sd[axis] / kDays;
      }
      for (const calibration::UncertainPoint& one : points[kind])
        squares += (one.value[axis] - mean) * (one.value[axis] - mean) / (kDays - 1);
      EXPECT_NEAR(std::sqrt(squares / stated), 1.0, 0.3) << kind << ", " << axis;
    }
  }
}

}  // namespace position_errors_test
}  // namespace stiffscope
