#include "metrology/linear_algebra.h"

#include <gtest/gtest.h>

namespace stiffscope {
namespace linear_algebra_test {

TEST(LeastSquaresSolution, LeavesOutWhatTheThresholdCallsUnseen) {
  // Along y the matrix stretches by a hundred-thousandth of what it does along x.
  const Eigen::MatrixXd a = Eigen::Vector2d(1.0, 1e-5).asDiagonal();
  const Eigen::VectorXd b = Eigen::Vector2d(2.0, 3e-5);
  EXPECT_TRUE(leastSquaresSolution(a, b).isApprox(Eigen::Vector2d(2.0, 3.0), 1e-12));
  EXPECT_TRUE(leastSquaresSolution(a, b, 1e-4).isApprox(Eigen::Vector2d(2.0, 0.0), 1e-12));
}

TEST(SolvePositive, ByHandAndWhereCholeskyBreaksDown) {
  Eigen::MatrixXd a(2, 2);
  a << 4.0, 2.0, 2.0, 3.0;
  Eigen::MatrixXd b(2, 1);
  b << 8.0, 8.0;
  EXPECT_TRUE(solvePositive(a, b).isApprox(Eigen::Vector2d(1.0, 2.0), 1e-14));
  a << 1.0, 0.0, 0.0, -2.0;  // symmetric, not positive
  EXPECT_TRUE(solvePositive(a, b).isApprox(Eigen::Vector2d(8.0, -4.0), 1e-14));
}

TEST(CholeskyLower, ByHand) {
  Eigen::MatrixXd a(2, 2), lower(2, 2);
  a << 4.0, 99.0, 2.0, 10.0;  // the upper half is not read
  lower << 2.0, 0.0, 1.0, 3.0;
  EXPECT_TRUE(choleskyLower(a).isApprox(lower, 1e-15));
}

TEST(MahalanobisSquared, OfSixIsThatOfAnyNumber) {
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Identity();
  Eigen::Matrix<double, 6, 1> v;
  for (int i = 0; i < 6; ++i) {
    v[i] = 1.0 + i;
    for (int j = 0; j < i; ++j) root(i, j) = 0.1 * (i - 2 * j);
  }
  // v = root w: the squared distance is that of w from zero, 6 for ones.
  const Eigen::Matrix<double, 6, 6> covariance = root * root.transpose();
  const Eigen::Matrix<double, 6, 1> of_ones = root * Eigen::Matrix<double, 6, 1>::Ones();
  EXPECT_NEAR(mahalanobisSquared(of_ones, covariance), 6.0, 1e-13);
  EXPECT_NEAR(mahalanobisSquared(v, covariance), mahalanobisSquared(Eigen::VectorXd(v), Eigen::MatrixXd(covariance)),
              1e-10);  // two orders of the same sums, a few hundred large
}

}  // namespace linear_algebra_test
}  // namespace stiffscope
