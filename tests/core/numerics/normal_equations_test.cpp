#include "core/numerics/normal_equations.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace normal_equations_test {

// Many rows are multiplied in blocks, and columns of nothing are left out of it; few rows at once.
TEST(NormalMatrix, IsTheProductWithAndWithoutEmptyColumns) {
  Noise noise(3);
  for (const Eigen::Index rows : {Eigen::Index{90}, Eigen::Index{1200}}) {
    Eigen::MatrixXd equations(rows, 70);
    for (double& entry : equations.reshaped()) entry = noise.normal();
    const auto expectProduct = [&] {
      const Eigen::MatrixXd normal = numerics::normalMatrix(equations), product = equations.transpose() * equations;
      EXPECT_LT((normal - product).cwiseAbs().maxCoeff(), 1e-12 * static_cast<double>(rows)) << rows;
      EXPECT_EQ(normal, Eigen::MatrixXd(normal.transpose()));
    };
    expectProduct();
    for (const Eigen::Index empty : {0, 31, 32, 33, 69}) equations.col(empty).setZero();
    expectProduct();
    equations.setZero();
    EXPECT_TRUE(numerics::normalMatrix(equations).isZero(0.0));
  }
}

// A choice of frame is seen by some 1e-4 of its length where a calibration is off by as much, and is a choice still.
TEST(ColumnsInSpan, WhatIsNewByLessThanAThousandthIsNotSeen) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(5, 4);
  columns(0, 0) = columns(1, 1) = 1.0;
  columns.col(2) << 3.0, -2.0, 4e-4, 0.0, 0.0;
  columns.col(3) << 1.0, 1.0, 0.0, 1e-2, 0.0;
  EXPECT_EQ(numerics::columnsInSpanOfEarlier(columns, {0, 1, 2, 3}), std::vector<int>{2});
}

}  // namespace normal_equations_test
}  // namespace stiffscope
