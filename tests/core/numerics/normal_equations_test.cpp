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

}  // namespace normal_equations_test
}  // namespace stiffscope
