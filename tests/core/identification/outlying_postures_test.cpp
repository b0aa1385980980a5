#include "core/identification/outliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stiffscope {
namespace outlying_postures_test {

const robot::JointMask kThree{false, true, true, true, false, false};

std::vector<identification::CaseEquations> postures(int count) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  JointVector truth = JointVector::Zero(6);
  truth.segment<3>(1) << 2.0, 1.0, 3.0;
  std::vector<identification::CaseEquations> equations;
  for (int p = 0; p < count; ++p) {
    identification::CaseEquations one;
    one.matrix = Eigen::MatrixXd::NullaryExpr(9, 6, [&] { return normal(random); });
    one.right = one.matrix * truth + 0.1 * Eigen::VectorXd::NullaryExpr(9, [&] { return normal(random); });
    one.posture = p;
    equations.push_back(one);
  }
  return equations;
}

double rms(const std::vector<identification::CaseEquations>& equations, const JointVector& compliance) {
  double sum = 0.0, count = 0.0;
  for (const identification::CaseEquations& one : equations) {
    sum += (one.right - one.matrix * compliance).squaredNorm();
    count += static_cast<double>(one.right.size());
  }
  return std::sqrt(sum / count);
}

TEST(OutlyingPostures, OfSoundOnesAreNone) {
  EXPECT_TRUE(identification::outlyingPostures(postures(40), kThree).empty());
}

TEST(OutlyingPostures, AreJudgedByTheFitToTheOthers) {
  std::vector<identification::CaseEquations> equations = postures(40);
  equations[7].right.array() += 1.0;
  equations[21].right.array() -= 3.0;
  const std::vector<identification::OutlyingPosture> found = identification::outlyingPostures(equations, kThree);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].posture, 21);
  EXPECT_EQ(found[1].posture, 7);

  // By hand: least squares of all others, the second without the first too.
  std::vector<identification::CaseEquations> others;
  identification::NormalEquations sum;
  for (const identification::CaseEquations& one : equations) {
    if (one.posture == 21 || one.posture == 7) continue;
    others.push_back(one);
    sum += identification::normalEquations(one);
  }
  const JointVector compliance = identification::solveNormal(sum, kThree);
  EXPECT_NEAR(found[1].rms, rms({equations[7]}, compliance), 1e-9);  // rounding of sums that one posture is taken from
  EXPECT_NEAR(found[1].others, rms(others, compliance), 1e-9);
  EXPECT_LT(found[1].p_value, 1e-3);
}

}  // namespace outlying_postures_test
}  // namespace stiffscope
