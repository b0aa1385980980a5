#include "core/identification/method_runs.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace length_sensitivity_test {

using identification::CaseEquations;
using identification::Method;

/// Pose equations with errors of these standard deviations, m and rad.
std::vector<CaseEquations> noisyPoses(int postures, double of_displacement, double of_rotation) {
  const LinearMachine machine(postures, 1.0, 21);
  std::vector<CaseEquations> rows = machine.poseEquations();
  Noise noise(22);
  for (CaseEquations& one : rows) {
    one.right = one.matrix * machine.compliance;
    one.right.head<3>() += of_displacement * noise.normal3();
    one.right.tail<3>() += of_rotation * noise.normal3();
  }
  return rows;
}

/// Weighted least squares by QR of the stacked rows.
JointVector weighted(const std::vector<CaseEquations>& rows, double length) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix(6 * count, 6);
  Eigen::VectorXd right(6 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const CaseEquations& one = rows[static_cast<std::size_t>(i)];
    matrix.middleRows<6>(6 * i) = one.matrix;
    right.segment<6>(6 * i) = one.right;
    matrix.middleRows<3>(6 * i) /= length;
    right.segment<3>(6 * i) /= length;
  }
  // Columns of one size: compliances differ by a hundred.
  const Eigen::VectorXd scale = matrix.colwise().norm().cwiseInverse();
  return scale.asDiagonal() * (matrix * scale.asDiagonal()).colPivHouseholderQr().solve(right);
}

TEST(ResidualVarianceLength, IsTheRatioOfTheErrors) {
  // 2 x 900 numbers: the ratio of their deviations is known to 1 / sqrt(900), three times that.
  for (const double length : {0.2, 1.0, 5.0}) {
    const std::vector<CaseEquations> rows = noisyPoses(300, 1e-5 * length, 1e-5);
    for (const double start : {0.1, 10.0}) {
      const auto found = identification::residualVarianceLength(rows, kAllJoints, start);
      ASSERT_TRUE(found);
      EXPECT_NEAR(*found / length, 1.0, 0.1) << length;
    }
  }
}

TEST(ResidualVarianceLength, IsAFixedPointByAnotherSolver) {
  const std::vector<CaseEquations> rows = noisyPoses(12, 4e-5, 1e-4);
  const auto found = identification::residualVarianceLength(rows, kAllJoints, 1.0);
  ASSERT_TRUE(found);
  const JointVector compliance = weighted(rows, *found);
  double displacement = 0.0, rotation = 0.0;
  for (const CaseEquations& one : rows) {
    const Eigen::VectorXd left = one.right - one.matrix * compliance;
    displacement += left.head(3).squaredNorm();
    rotation += left.tail(3).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(displacement / rotation) / *found, 1.0, 1e-7);  // the iteration's own limit is 1e-9
}

TEST(ResidualVarianceLength, NoneWhereABlockLeavesNothingOrTheRatioIsBeyondTheTable) {
  EXPECT_FALSE(identification::residualVarianceLength(noisyPoses(20, 1e-3, 1e-6), kAllJoints, 1.0));  // 1 km
  EXPECT_FALSE(identification::residualVarianceLength(noisyPoses(20, 1e-7, 1e-4), kAllJoints, 1.0));  // 1 mm
  EXPECT_FALSE(identification::residualVarianceLength({}, kAllJoints, 1.0));
}

TEST(StudyLengths, AtItsOwnLengthCompletePoseIsWhatItIs) {
  const campaign::Campaign day =
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
  identification::IdentifyOptions options;
  options.subsets.size = 18;  // 19 subsets: all of them at every length, too
  identification::Identification found = identification::identify(day, options);
  const identification::MethodResult& own = found.of(Method::complete_pose);
  ASSERT_TRUE(own.available);
  for (auto& [length, condition] : found.characteristic_length.curve) length = found.characteristic_length.length;
  identification::studyLengths(found.cases, options, found);
  const identification::LengthSensitivity& at = found.length_sensitivity.front();
  EXPECT_EQ(at.subsets, 19u);
  // Sums taken in another order: rounding times the condition squared.
  EXPECT_LT((at.compliance - own.estimate.compliance).norm(), 1e-9 * own.estimate.compliance.norm());
  EXPECT_NEAR(at.at_wrist->subsets.held_out, own.at_wrist->subsets.held_out, 1e-9);
  EXPECT_NEAR(at.at_targets->subsets.held_out, own.at_targets->subsets.held_out, 1e-9);
  EXPECT_NEAR(at.at_targets->held_out_sd, own.at_targets->held_out_sd, 1e-9);
  EXPECT_NEAR(at.at_wrist->all_postures, own.at_wrist->all_postures, 1e-9);
}

TEST(StudyLengths, TheSamplesShareFallsAsTheLengthGrows) {
  // By another program, on the same day with joint springs: 86 % at P_wrist at 0.3 m and by the residual variances,
  // 80 % where the condition number is least, 62 % at 2.5 m, 52 % with a spread of 8 % at 5 m.
  const campaign::Campaign day =
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
  identification::IdentifyOptions options;
  options.subsets.most_all = options.subsets.sample = 500;
  const identification::Identification found = identification::identify(day, options);
  ASSERT_TRUE(found.residual_length);
  EXPECT_NEAR(found.residual_length->at_wrist->subsets.all, 0.86, 0.01);
  EXPECT_NEAR(found.residual_length->at_targets->subsets.all, 0.908, 0.005);
  EXPECT_NEAR(found.of(Method::complete_pose).at_wrist->subsets.all, 0.80, 0.01);
  for (const identification::LengthSensitivity& one : found.length_sensitivity) {
    if (std::abs(one.length - 2.7) < 0.1) EXPECT_NEAR(one.at_wrist->subsets.all, 0.61, 0.02);
    if (std::abs(one.length - 4.5) < 0.1) {
      EXPECT_NEAR(one.at_wrist->subsets.all, 0.53, 0.02);
      EXPECT_NEAR(one.at_wrist->held_out_sd, 0.08, 0.015);
    }
  }
}

TEST(StudyLengths, FewerSubsetsOfMorePostures) {
  const identification::SubsetOptions asked;
  EXPECT_EQ(identification::subsetsOfALength(asked, 19, 14).sample, 500u);
  EXPECT_EQ(identification::subsetsOfALength(asked, 1000, 14).sample, 35u);  // 500 000 / 14 000
  EXPECT_EQ(identification::subsetsOfALength(asked, 10'000, 14).sample, 20u);
  identification::SubsetOptions few;
  few.sample = few.most_all = 5;
  EXPECT_EQ(identification::subsetsOfALength(few, 19, 14).sample, 5u);
}

}  // namespace length_sensitivity_test
}  // namespace stiffscope
