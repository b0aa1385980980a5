#include <gtest/gtest.h>

#include <cmath>
#include "core/calibration/calibrate.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace link_uncertainty_test {

/// The geometry of a day, as if no more had been fitted than the place of some axes outwards, along x.
class AxesMovedOutwards : public ::testing::Test {
 protected:
  void SetUp() override {
    Noise noise(52);
    const UnloadedSpec spec;
    campaign_ = unloadedCampaign(spec, noise);
    calibration_ = calibration::calibrate(campaign_, {});
    fit_ = calibration_.geometry().fit;
    fit_.free.clear();
  }

  /// The sign with which the parameter moves axis `j` to x.
  double freeAlongX(std::size_t j) {
    const metrology::MeasuredLine& axis = fit_.start.at(j);
    const bool by_u = std::abs(axis.across_u.x()) > std::abs(axis.across_v.x());
    fit_.free.push_back(4 * static_cast<int>(j) + (by_u ? 0 : 1));
    const double along = by_u ? axis.across_u.x() : axis.across_v.x();
    EXPECT_GT(std::abs(along), 0.999);
    return along > 0.0 ? 1.0 : -1.0;
  }

  PerJoint<calibration::LinkParameters> uncertainties() const {
    return calibration::linkUncertainties(fit_, calibration_.day.arm);
  }

  static constexpr double kSd = 0.1e-3;  // m
  campaign::Campaign campaign_;
  calibration::Calibration calibration_;
  calibration::ArmFit fit_;
};

// Axis 1 is vertical, axis 2 level beside it, axis 3 parallel to that and 1.12 m above it.
TEST_F(AxesMovedOutwards, OneAxisChangesItsDistanceAndTurnsTheNextLink) {
  freeAlongX(1);
  fit_.covariance = Eigen::MatrixXd::Constant(1, 1, kSd * kSd);
  const PerJoint<calibration::LinkParameters> sd = uncertainties();
  EXPECT_NEAR(sd[0].a, kSd, 1e-3 * kSd);
  EXPECT_LT(sd[0].alpha, 1e-9);
  EXPECT_NEAR(sd[1].theta, kSd / 1.12, 0.01 * kSd / 1.12);
  EXPECT_LT(sd[1].a, 0.01 * kSd);  // across the link
  EXPECT_LT(sd[3].a, 1e-9);        // nothing there was fitted
}

TEST_F(AxesMovedOutwards, WhatMovesBothAxesAlikeTurnsNothing) {
  const double signs = freeAlongX(1) * freeAlongX(2);
  fit_.covariance.resize(2, 2);
  fit_.covariance << 1.0, signs, signs, 1.0;
  fit_.covariance *= kSd * kSd;
  const PerJoint<calibration::LinkParameters> sd = uncertainties();
  EXPECT_NEAR(sd[0].a, kSd, 1e-3 * kSd);
  EXPECT_LT(sd[1].theta, 0.01 * kSd / 1.12);
}

}  // namespace link_uncertainty_test
}  // namespace stiffscope
