#include "core/comparison/paired_days.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/metrology/simulated_points.h"

// Equations of random numbers, errors of known variances in them, a fit by dense matrices.

namespace stiffscope {
namespace error_components_test {

constexpr Eigen::Index kPostures = 40, kRows = 9, kUnknowns = 20;

struct Made {
  comparison::FitEquations fit{calibration::UnloadedDay(), calibration::ArmFit()};
  Eigen::MatrixXd jacobian, turns;  ///< of all rows; six columns a posture
  Eigen::MatrixXd left;             ///< of any error by the fit

  explicit Made(Noise& noise)
      : jacobian(kPostures * kRows, kUnknowns), turns(Eigen::MatrixXd::Zero(kPostures * kRows, 6 * kPostures)) {
    fit.joints = 6;
    for (double& entry : jacobian.reshaped()) entry = noise.normal();
    for (Eigen::Index p = 0; p < kPostures; ++p) {
      calibration::PostureEquations of;
      of.by_parameters = jacobian.middleRows(kRows * p, kRows);
      of.by_angles.resize(kRows, 6);
      for (double& entry : of.by_angles.reshaped()) entry = noise.normal();
      of.residual = Eigen::VectorXd::Zero(kRows);
      turns.block(kRows * p, 6 * p, kRows, 6) = of.by_angles;
      fit.postures.push_back(static_cast<std::size_t>(p));
      fit.equations.push_back(std::move(of));
    }
    fit.normal_inverse = (jacobian.transpose() * jacobian).inverse();
    left = Eigen::MatrixXd::Identity(jacobian.rows(), jacobian.rows()) -
           jacobian * fit.normal_inverse * jacobian.transpose();
  }

  /// What a fit leaves of errors of these standard deviations.
  std::vector<Eigen::VectorXd> residuals(double coordinate, const JointVector& angle, Noise& noise) const {
    Eigen::VectorXd errors(jacobian.rows()), angles(6 * kPostures);
    for (double& one : errors) one = coordinate * noise.normal();
    for (Eigen::Index k = 0; k < angles.size(); ++k) angles[k] = angle[k % 6] * noise.normal();
    const Eigen::VectorXd all = left * (errors + turns * angles);
    std::vector<Eigen::VectorXd> by_posture;
    for (Eigen::Index p = 0; p < kPostures; ++p) by_posture.emplace_back(all.segment(kRows * p, kRows));
    return by_posture;
  }
};

// Rao's estimators have no bias: the mean of 300 draws is within four of its own standard deviations of the truth. All
// variances are far from zero, where they would be cut off.
TEST(ErrorComponents, HaveNoBias) {
  Noise noise(31);
  const Made made(noise);
  const JointVector angle = (Vector6d() << 1.5, 1.2, 2.0, 1.0, 1.8, 1.4).finished();
  constexpr double kCoordinate = 1.3;
  constexpr int kDraws = 300;
  Eigen::Matrix<double, 7, 1> sum = Eigen::Matrix<double, 7, 1>::Zero(), squares = sum, truth;
  truth << kCoordinate * kCoordinate, angle.cwiseAbs2();
  for (int draw = 0; draw < kDraws; ++draw) {
    const comparison::ErrorComponents found =
        comparison::errorComponents(made.fit, made.residuals(kCoordinate, angle, noise));
    Eigen::Matrix<double, 7, 1> one;
    one << found.coordinate, found.angle;
    sum += one, squares += one.cwiseAbs2();
  }
  const Eigen::Matrix<double, 7, 1> mean = sum / kDraws,
                                    sd = ((squares / kDraws - mean.cwiseAbs2()) / kDraws).cwiseSqrt();
  for (Eigen::Index k = 0; k < 7; ++k) EXPECT_NEAR(mean[k], truth[k], 4.0 * sd[k]) << k;
  EXPECT_LT(sd.maxCoeff(), 0.1);  // so that the comparison says something
}

TEST(ErrorComponents, AVarianceIsNeverNegative) {
  Noise noise(32);
  const Made made(noise);
  for (int draw = 0; draw < 50; ++draw) {
    const comparison::ErrorComponents found =
        comparison::errorComponents(made.fit, made.residuals(1.0, JointVector::Zero(6), noise));
    EXPECT_GE(found.angle.minCoeff(), 0.0);
    EXPECT_NEAR(found.coordinate, 1.0, 0.4);  // 340 degrees of freedom: 0.08 one sigma
  }
}

// 120 combinations of the coordinates are free of what joints do, less their share of the unknowns: the variance of
// coordinates is known to 14 %, however large the joints' errors are. With weights of 1 it is lost in these.
TEST(ErrorComponents, CoordinatesAreSeenBesideLargeErrorsOfJoints) {
  Noise noise(34);
  const Made made(noise);
  constexpr double kCoordinate = 0.1;
  for (int draw = 0; draw < 20; ++draw) {
    const comparison::ErrorComponents found =
        comparison::errorComponents(made.fit, made.residuals(kCoordinate, JointVector::Constant(6, 2.0), noise), 1e-4);
    EXPECT_NEAR(found.coordinate, kCoordinate * kCoordinate, 0.6 * kCoordinate * kCoordinate) << draw;
    // Forty errors of each joint, not all of them apart from the unknowns.
    for (Eigen::Index joint = 0; joint < 6; ++joint) EXPECT_NEAR(found.angle[joint], 4.0, 4.0) << draw;
  }
}

TEST(ErrorComponents, CoordinatesErrByNoLessThanIsDeclared) {
  Noise noise(35);
  const Made made(noise);
  const comparison::ErrorComponents found =
      comparison::errorComponents(made.fit, made.residuals(0.5, JointVector::Constant(6, 1.0), noise), 0.6);
  EXPECT_DOUBLE_EQ(found.coordinate, 0.6);
  for (Eigen::Index joint = 0; joint < 6; ++joint) EXPECT_NEAR(found.angle[joint], 1.0, 1.0);
}

// N^-1 J^T S J N^-1 by the dense covariance S of all rows; no prior, so that it has no share.
TEST(ErrorComponents, TheCovarianceIsThatOfLeastSquares) {
  Noise noise(33);
  const Made made(noise);
  comparison::ErrorComponents errors(6);
  errors.coordinate = 0.7;
  errors.angle << 0.2, 0.0, 1.1, 0.4, 0.9, 0.3;
  const Eigen::MatrixXd angles =
      made.turns * errors.angle.replicate(kPostures, 1).asDiagonal() * made.turns.transpose();
  const Eigen::MatrixXd all =
      angles + errors.coordinate * Eigen::MatrixXd::Identity(made.jacobian.rows(), made.jacobian.rows());
  const Eigen::MatrixXd estimator = made.fit.normal_inverse * made.jacobian.transpose();
  const Eigen::MatrixXd expected = estimator * all * estimator.transpose();
  const Eigen::MatrixXd found = comparison::covarianceBy(made.fit, errors);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
}

}  // namespace error_components_test
}  // namespace stiffscope
