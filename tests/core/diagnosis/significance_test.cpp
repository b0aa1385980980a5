#include "core/diagnosis/verdict.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

// One effect of one parameter: what chance does to it is a chi-square of one degree of freedom.

namespace stiffscope {
namespace significance_test {

constexpr double kNoise = 20e-6;  // m, of one state's displacement, per coordinate
constexpr double kRows = 540.0;

/// A fit of nothing to `postures` postures, the column of the effect of this square before and after the projection.
struct OneColumn {
  campaign::Campaign campaign;
  diagnosis::SystemInput input{.campaign = campaign, .noise = {}, .models = {}, .expected = {}};
  diagnosis::GapFit fit;
  std::vector<bool> allowed{true};

  OneColumn(std::size_t postures, double before, double kept) {
    effects::EffectModel model;
    model.effect = effects::Effect::bearing_tilt;
    model.parts.push_back({"joint 2", {1e6}, false, "1"});
    input.models.push_back(model);
    diagnosis::LinearSystem data;
    data.layout.effects = 6, data.layout.end = 7, data.layout.model_at = {6};
    data.postures.resize(postures);
    data.state_noise = kNoise;
    fit.data = std::make_shared<const diagnosis::LinearSystem>(std::move(data));
    fit.rules.loading_rows = kRows;
    fit.projection.matrix = Eigen::MatrixXd::Constant(1, 1, kept * before);
    fit.projection.before = Eigen::VectorXd::Constant(1, before);
    fit.projection.right = Eigen::VectorXd::Zero(1);
  }

  double limit(double false_alarm, std::uint64_t seed) const {
    return diagnosis::chanceLimit(input, fit, allowed, 4000, false_alarm, seed);
  }
};

// Chi-square of one degree exceeds 6.635 in 1 % and 3.841 in 5 % of draws; 4000 draws know these to 0.3 and 0.12, one
// sigma. The score is less by the price of the parameter, ln(5) for five postures, which is the same at both levels.
TEST(ChanceLimit, IsAChiSquareLessThePrice) {
  const OneColumn one(5, 3.0, 1.0);
  const double at_1 = one.limit(0.01, 7), at_5 = one.limit(0.05, 7);
  EXPECT_NEAR(at_1 - at_5, 6.635 - 3.841, 1.0);
  EXPECT_NEAR(at_5, 3.841 - std::log(5.0), 0.4);
  EXPECT_EQ(one.limit(0.05, 7), at_5);
  // A column ten thousand times as long is the same question.
  EXPECT_NEAR(OneColumn(5, 3e8, 1.0).limit(0.05, 7), at_5, 1e-6);
}

TEST(ChanceLimit, IsZeroWhereThePriceIsAboveAnyChance) {
  EXPECT_EQ(OneColumn(100000, 3.0, 1.0).limit(0.05, 7), 0.0);  // ln(100000) is 11.5
}

TEST(SizeOfDrop, IsTheRootMeanSquareThatMakesIt) {
  const OneColumn one(5, 3.0, 1.0);
  // 9 kRows of chi2: three times the noise in every equation.
  EXPECT_NEAR(diagnosis::sizeOfDrop(one.fit, 9.0 * kRows), 3.0 * kNoise, 1e-18);
  EXPECT_EQ(diagnosis::sizeOfDrop(one.fit, -1.0), 0.0);
}

// Of an effect of which joint stiffnesses soak up three quarters of the squares twice as much is needed; of one of
// which they leave nothing no size would show.
TEST(DetectableSizes, GrowByWhatTheStiffnessesSoakUp) {
  const auto sizeOf = [](double kept) {
    OneColumn one(5, 3.0, kept);
    one.fit.rules.detect = 25.0, one.fit.rules.least_drop = 10.0;
    const auto sizes = diagnosis::detectableSizes(one.input, one.fit, one.allowed);
    return sizes[static_cast<std::size_t>(effects::Effect::bearing_tilt)].size;
  };
  ASSERT_TRUE(sizeOf(1.0) && sizeOf(0.25));
  EXPECT_NEAR(*sizeOf(1.0), 5.0 / std::sqrt(kRows) * kNoise, 1e-15);
  EXPECT_NEAR(*sizeOf(0.25), 2.0 * *sizeOf(1.0), 1e-15);
  EXPECT_FALSE(sizeOf(1e-6));
}

// By hand: chi2 over f degrees of freedom has the variance 2 / f, that of a noise estimated with g of its own 2 / g.
TEST(Significance, TheDoubtOfTheNoiseDoesNotShrinkWithTheRows) {
  EXPECT_NEAR(diagnosis::limitOfChiSquare(171.0, 1710.0), 1.0 + 4.0 * std::sqrt(2.0 / 171.0 + 2.0 / 1710.0), 1e-12);
  // As declared: right to a quarter.
  EXPECT_NEAR(diagnosis::limitOfChiSquare(200.0, 0.0), 1.6 + 0.4, 1e-12);
}

}  // namespace significance_test
}  // namespace stiffscope
