#include "core/identification/outliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <set>

namespace stiffscope {
namespace outlying_postures_test {

const robot::JointMask kThree{false, true, true, true, false, false};

std::vector<identification::CaseEquations> postures(int count, std::uint64_t seed = 3) {
  std::mt19937_64 random(seed);
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

std::set<int> places(const std::vector<identification::OutlyingPosture>& found) {
  std::set<int> postures;
  for (const identification::OutlyingPosture& one : found) postures.insert(one.posture);
  return postures;
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

// Four that err alike: with the three others in the fit none is far from what it leaves.
TEST(OutlyingPostures, DoNotHideEachOther) {
  const std::set<int> wrong{3, 8, 12, 16};
  for (const double off : {0.5, 1.0}) {
    std::vector<identification::CaseEquations> equations = postures(19);
    for (const int p : wrong) equations[static_cast<std::size_t>(p)].right.array() += off;
    const std::vector<identification::OutlyingPosture> found = identification::outlyingPostures(equations, kThree);
    EXPECT_EQ(places(found), wrong) << off;

    std::vector<identification::CaseEquations> others;
    identification::NormalEquations sum;
    for (const identification::CaseEquations& one : equations) {
      if (wrong.contains(one.posture)) continue;
      others.push_back(one);
      sum += identification::normalEquations(one);
    }
    const JointVector compliance = identification::solveNormal(sum, kThree);
    for (const identification::OutlyingPosture& one : found) {
      EXPECT_NEAR(one.rms, rms({equations[static_cast<std::size_t>(one.posture)]}, compliance), 1e-9);
      EXPECT_NEAR(one.others, rms(others, compliance), 1e-9);
      EXPECT_LT(one.p_value, 1e-3);
    }
  }
}

// Loads of which too little was written: 70 % of a torque asks for displacements that were larger.
TEST(OutlyingPostures, OfWrongLoadsAreFoundWithTheirSprings) {
  const std::set<int> wrong{3, 8, 12, 16};
  std::vector<identification::CaseEquations> equations = postures(19);
  for (const int p : wrong) equations[static_cast<std::size_t>(p)].matrix *= 0.7;
  EXPECT_EQ(places(identification::outlyingPostures(equations, kThree)), wrong);
}

// What a model lacks puts all postures off, some more than others: none of these is apart from the rest, and more than
// a quarter is no outlier.
TEST(OutlyingPostures, AreNotThoseThatAModelMisses) {
  std::vector<identification::CaseEquations> missed = postures(24);
  for (std::size_t p = 0; p < missed.size(); ++p) {
    const bool more = p % 6 == 2;
    missed[p].right.array() += more ? 0.6 : p % 2 == 0 ? 0.1 : -0.1;
  }
  EXPECT_TRUE(identification::outlyingPostures(missed, kThree).empty());

  std::vector<identification::CaseEquations> many = postures(24);
  for (std::size_t p = 0; p < 8; ++p) many[3 * p].right.array() += 1.0;
  EXPECT_TRUE(identification::outlyingPostures(many, kThree).empty());
}

// By chance one day in a thousand has any, however many are suspected at once: five of 1500 is beyond 1 in 50.
TEST(OutlyingPostures, KeepTheirLevel) {
  int days = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed)
    days += !identification::outlyingPostures(postures(12, seed), kThree).empty();
  EXPECT_LE(days, 5);
}

}  // namespace outlying_postures_test
}  // namespace stiffscope
