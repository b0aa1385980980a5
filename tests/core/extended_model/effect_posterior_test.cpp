#include "core/extended_model/hidden_effects.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace stiffscope::extended_model {
namespace {

double normalDensity(double x, double sd) {
  return std::exp(-0.5 * x * x / (sd * sd)) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

/// The horseshoe's density of one parameter that is an effect by itself: the product v of two half Cauchy numbers of
/// scale 1 has density 4/pi^2 ln v / (v^2 - 1); integrated here over ln v.
double integratedPrior(double x) {
  double sum = 0.0;
  constexpr double kStep = 0.02;
  for (double u = -18.0 + 0.5 * kStep; u < 14.0; u += kStep) {
    const double v = std::exp(u);
    const double density = std::abs(v - 1.0) < 1e-9 ? 0.5 : u / (v * v - 1.0);
    sum += normalDensity(x, kUsual * v) * 4.0 / (std::numbers::pi * std::numbers::pi) * density * v * kStep;
  }
  return sum;
}

/// The same from a table in ln |x|, whose steps are far below what the density needs.
double priorDensity(double x) {
  constexpr double kFirst = -20.0, kStep = 0.01;
  constexpr std::size_t kCount = 2400;
  static const std::vector<double> table = [] {
    std::vector<double> values;
    for (std::size_t i = 0; i < kCount; ++i)
      values.push_back(integratedPrior(std::exp(kFirst + kStep * static_cast<double>(i))));
    return values;
  }();
  const double at = std::clamp((std::log(std::abs(x) + 1e-300) - kFirst) / kStep, 0.0, static_cast<double>(kCount - 2));
  const auto i = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(i);
  return (1.0 - share) * table[i] + share * table[i + 1];
}

/// Of a density on a grid fine near zero, where the prior has its pole: numbers +-exp(s).
struct Grid {
  std::vector<double> x, weight;

  explicit Grid(bool positive) {
    constexpr double kStep = 0.003;
    for (double s = std::log(1e-7); s < std::log(20.0); s += kStep) {
      const double size = std::exp(s);
      if (!positive) x.push_back(-size), weight.push_back(size * kStep);
      x.push_back(size), weight.push_back(size * kStep);
    }
  }
};

EffectEvidence evidence(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right, std::vector<bool> positive) {
  EffectEvidence one;
  one.normal = normal;
  one.right = right;
  one.positive = std::move(positive);
  for (std::size_t i = 0; i < one.positive.size(); ++i) one.group.push_back(i);
  return one;
}

double shareBelow(const Eigen::MatrixXd& draws, Eigen::Index row, double limit) {
  return (draws.row(row).array() < limit).cast<double>().mean();
}

/// Draws are correlated; of 20,000 some thousands count. The steps of the grid are a tenth of the smallest spread.
constexpr double kTolerance = 0.025;
constexpr PosteriorOptions kMany{20000, 2, 500, 3};

void compareOne(double mean, double sd, bool positive) {
  const Eigen::MatrixXd normal = Eigen::MatrixXd::Constant(1, 1, 1.0 / (sd * sd));
  const Eigen::MatrixXd draws =
      drawEffects(evidence(normal, Eigen::VectorXd::Constant(1, mean / (sd * sd)), {positive}), kMany);
  const Grid grid(positive);
  std::vector<double> mass;
  double whole = 0.0;
  for (std::size_t i = 0; i < grid.x.size(); ++i) {
    mass.push_back(grid.weight[i] * priorDensity(grid.x[i]) * normalDensity(grid.x[i] - mean, sd));
    whole += mass.back();
  }
  for (const double limit : {-0.5 * sd, -0.1 * sd, 0.1 * sd, 0.5 * sd, mean, mean + sd}) {
    if (positive && limit <= 0.0) continue;
    double below = 0.0;
    for (std::size_t i = 0; i < grid.x.size(); ++i) below += grid.x[i] < limit ? mass[i] : 0.0;
    EXPECT_NEAR(shareBelow(draws, 0, limit), below / whole, kTolerance) << "below " << limit << " of mean " << mean;
  }
}

TEST(EffectPosterior, OneParameterByNumericalIntegration) {
  compareOne(0.0, 0.05, false);
  compareOne(0.1, 0.05, false);
  compareOne(0.5, 0.02, false);
}

TEST(EffectPosterior, OnePositiveParameterByNumericalIntegration) {
  compareOne(0.02, 0.05, true);
  compareOne(-0.05, 0.03, true);
}

TEST(EffectPosterior, APairThatTheDataCannotTellApart) {
  // x + y = 0.3 +- 0.01 and nearly nothing of x - y; x positive.
  Eigen::Matrix2d normal;
  normal << 1e4, 1e4, 1e4, 1e4;
  normal += 4.0 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d right(3000.0, 3000.0);
  const Eigen::MatrixXd draws = drawEffects(evidence(normal, right, {true, false}), kMany);
  // Along the valley y = 0.3 - x by a grid of its own, across it by 17 points of the normal number.
  double whole = 0.0, mean_x = 0.0;
  for (double x = 5e-5; x < 3.0; x += 1e-4) {
    for (double z = -4.0; z <= 4.0; z += 0.5) {
      const double y = 0.3 - x + 0.01 * z;
      const Eigen::Vector2d at(x, y);
      const double chi2 = at.dot(normal * at) - 2.0 * right.dot(at);
      const double mass = priorDensity(x) * priorDensity(y) * std::exp(-0.5 * (chi2 + 900.0));
      whole += mass;
      mean_x += mass * std::min(x, 0.6);
    }
  }
  EXPECT_NEAR(draws.row(0).array().min(0.6).mean(), mean_x / whole, 0.03);
  EXPECT_NEAR((draws.row(0) + draws.row(1)).mean(), 0.3, 0.005);
  EXPECT_GE(draws.row(0).minCoeff(), 0.0);
}

// A normal prior and normal data: sd^-2 = 1/0.2^2 + 1/0.1^2, mean the data's 0.3 weighed with the prior's 0. A second
// parameter, which the data do not see and nothing declares, keeps the horseshoe.
TEST(EffectPosterior, WhatIsDeclaredIsANormalPrior) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  normal(0, 0) = 1.0 / (0.1 * 0.1);
  EffectEvidence one = evidence(normal, Eigen::Vector2d(0.3 * normal(0, 0), 0.0), {false, false});
  one.known_sd = {0.2, 0.0};
  const Eigen::MatrixXd draws = drawEffects(one, kMany);
  const double weight = 25.0 + 100.0, mean = 0.3 * 100.0 / weight, sd = 1.0 / std::sqrt(weight);
  EXPECT_NEAR(draws.row(0).mean(), mean, 5.0 * sd / std::sqrt(20000.0));
  EXPECT_NEAR((draws.row(0).array() - draws.row(0).mean()).square().mean(), sd * sd, 0.05 * sd * sd);
  EXPECT_NEAR(shareBelow(draws, 0, mean + sd), 0.8413, kTolerance);
  EXPECT_GT((draws.row(1).array().abs() > 10.0 * kUsual).cast<double>().mean(), 0.02);  // tails that no normal has
}

/// P(y < limit) of a positive y that no data see, beside a positive x seen as mean +- sd, both normal with one standard
/// deviation kUsual v: over ln v by hand, x and y in closed form.
double shareBelowBesideAnAlike(double mean, double sd, double limit) {
  double below = 0.0, whole = 0.0;
  constexpr double kStep = 0.01;
  for (double u = -16.0; u < 12.0; u += kStep) {
    const double v = std::exp(u), prior_sd = kUsual * v;
    const double density = std::abs(v - 1.0) < 1e-9 ? 0.5 : u / (v * v - 1.0);
    const double both = std::hypot(sd, prior_sd), x_mean = mean * prior_sd * prior_sd / (both * both),
                 x_sd = sd * prior_sd / both;
    const double seen = normalDensity(mean, both) * std::erfc(-x_mean / (x_sd * std::numbers::sqrt2));
    const double mass = density * v * seen;
    whole += mass;
    below += mass * std::erf(limit / (prior_sd * std::numbers::sqrt2));
  }
  return below / whole;
}

// A link that hardly bends is known to hardly twist, though nobody has seen it twist; one that bends may.
TEST(EffectPosterior, ParametersThatAreAlikeShareTheirScale) {
  constexpr double kSd = 0.002;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  normal(0, 0) = 1.0 / (kSd * kSd);
  for (const double mean : {0.0, 0.02, 0.3}) {
    EffectEvidence one = evidence(normal, Eigen::Vector2d(mean * normal(0, 0), 0.0), {true, true});
    one.group = {0, 0};
    one.scale = {0, 0};
    const Eigen::MatrixXd draws = drawEffects(one, kMany);
    for (const double limit : {0.001, 0.01, 0.1, 1.0})
      EXPECT_NEAR(shareBelow(draws, 1, limit), shareBelowBesideAnAlike(mean, kSd, limit), kTolerance)
          << "below " << limit << " beside " << mean;
    one.scale = {0, 1};
    const double smaller = shareBelow(draws, 1, 0.01) - shareBelow(drawEffects(one, kMany), 1, 0.01);
    if (mean == 0.0) EXPECT_GT(smaller, 0.05);
    if (mean == 0.3) EXPECT_LT(smaller, -0.05);
  }
}

// Two compliances of which the data see the sum, and hardly which of the two it is, as of a joint's bearing and the
// link that stands on it. One by one they go to and fro a hundredth of their valley at a time.
TEST(EffectPosterior, ALongValleyIsWalkedFromEndToEnd) {
  constexpr double kSum = 0.3, kSd = 5e-5;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Constant(1.0 / (kSd * kSd));
  normal += 4.0 * Eigen::Matrix2d::Identity();
  const EffectEvidence one = evidence(normal, Eigen::Vector2d::Constant(kSum / (kSd * kSd) + 2.0 * kSum), {true, true});
  // Either has all of it or they share: along x + y = kSum by a grid that is fine at both ends.
  double whole = 0.0, at_ends = 0.0;
  for (double s = std::log(1e-9); s < std::log(0.5 * kSum); s += 0.001) {
    const double x = std::exp(s), y = kSum - x, off = 0.5 * (x - y);
    const double mass = x * priorDensity(x) * priorDensity(y) * std::exp(-4.0 * off * off);
    whole += mass;
    at_ends += x < 0.05 * kSum ? mass : 0.0;
  }
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Eigen::ArrayXd x = drawEffects(one, {4000, 2, 150, seed}).row(0).transpose();
    EXPECT_NEAR((x < 0.05 * kSum || x > 0.95 * kSum).cast<double>().mean(), at_ends / whole, 0.05) << seed;
    EXPECT_NEAR((x < 0.5 * kSum).cast<double>().mean(), 0.5, 0.15) << seed;
  }
}

// A bearing at one joint, or both turns of what stands behind it alike: the data see the sum of all and that the turns
// are alike, and the prior would rather have one explanation than a little of each.
TEST(EffectPosterior, OneExplanationIsExchangedForTheOther) {
  constexpr double kSum = 0.33, kSd = 0.004, kAlikeSd = 0.02;
  const Eigen::RowVector3d sum(1.0, 0.5, 0.5), apart(0.0, 1.0, -1.0);
  const Eigen::Matrix3d normal =
      sum.transpose() * sum / (kSd * kSd) + apart.transpose() * apart / (kAlikeSd * kAlikeSd);
  EffectEvidence one = evidence(normal, sum.transpose() * kSum / (kSd * kSd), {true, true, true});
  one.group = {0, 1, 1};
  one.scale = {0, 1, 1};
  // Of the two turns, r from the origin: the density that they have of a shared scale, over ln v by hand.
  const auto turnsDensity = [](double square) {
    double density = 0.0;
    for (double u = -16.0; u < 12.0; u += 0.05) {
      const double v = std::exp(u) * kUsual, ratio = std::exp(2.0 * u) - 1.0;
      const double prior = std::abs(ratio) < 1e-9 ? 0.5 : u / ratio;
      density += 0.05 * std::exp(u) * prior * std::exp(-0.5 * square / (v * v)) / (v * v);
    }
    return density;
  };
  double whole = 0.0, by_turns = 0.0;
  for (double s = std::log(1e-6); s < std::log(0.8); s += 0.04) {
    for (double t = std::log(1e-6); t < std::log(0.8); t += 0.04) {
      const double first = std::exp(s), second = std::exp(t);
      const double alike = (first - second) / kAlikeSd;
      const double turns =
          first * second * turnsDensity(first * first + second * second) * std::exp(-0.5 * alike * alike);
      if (turns == 0.0) continue;
      for (double z = -4.0; z <= 4.0; z += 0.25) {
        const double x = kSum - 0.5 * (first + second) + kSd * z;
        if (x <= 0.0) continue;
        const double mass = turns * priorDensity(x) * std::exp(-0.5 * z * z);
        whole += mass;
        by_turns += x < 0.5 * kSum ? mass : 0.0;
      }
    }
  }
  ASSERT_GT(by_turns / whole, 0.02);
  double share = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Eigen::ArrayXd x = drawEffects(one, {4000, 2, 150, seed}).row(0).transpose();
    const double here = (x < 0.5 * kSum).cast<double>().mean();
    EXPECT_NEAR(here, by_turns / whole, 0.08) << seed;
    share += here / kSeeds;
  }
  EXPECT_NEAR(share, by_turns / whole, 0.03);
}

// Evidence that another processor has otherwise in its ninth digit makes draws that differ hardly more.
TEST(EffectPosterior, RoundingOfTheEvidenceStaysRounding) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr Eigen::Index kCount = 24;
  Eigen::MatrixXd columns(60, kCount);
  for (double& value : columns.reshaped()) value = normal(random) / 0.02;
  for (Eigen::Index i = 0; i + 4 < kCount; i += 4) columns.col(i) = columns.col(i + 4) + 0.05 * columns.col(i);
  EffectEvidence one = evidence(columns.transpose() * columns, {}, std::vector<bool>(kCount, true));
  for (std::size_t i = 0; i < kCount; ++i) {
    one.group[i] = i / 4, one.scale.push_back(i % 4 == 3 ? i - 1 : i);
    one.positive[i] = i % 3 != 1;
  }
  for (std::size_t i = 3; i < kCount; i += 4) one.positive[i] = one.positive[i - 1];
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(kCount);
  truth[0] = 0.3, truth[9] = 0.05;
  Eigen::VectorXd read = columns * truth;
  for (double& value : read) value += normal(random);
  one.right = columns.transpose() * read;
  EffectEvidence other = one;
  for (double& value : other.right) value *= 1.0 + 1e-9 * normal(random);
  const Eigen::MatrixXd draws = drawEffects(one), others = drawEffects(other);
  EXPECT_LT((draws - others).cwiseAbs().maxCoeff(), 1e-5);
}

/// Parameters as the prior draws them, by the standard library alone.
Eigen::VectorXd fromPrior(const EffectEvidence& one, std::mt19937_64& random) {
  std::cauchy_distribution<double> cauchy;
  std::normal_distribution<double> normal;
  std::vector<double> scale(one.group.size()), effect(one.group.size());
  for (double& l : scale) l = std::abs(cauchy(random));
  for (double& t : effect) t = kUsual * std::abs(cauchy(random));
  Eigen::VectorXd x(static_cast<Eigen::Index>(one.group.size()));
  for (std::size_t i = 0; i < one.group.size(); ++i) {
    const bool known = i < one.known_sd.size() && one.known_sd[i] > 0.0;
    const double sd = known ? one.known_sd[i] : scale[one.scale[i]] * effect[one.group[i]];
    const double drawn = sd * normal(random);
    x[static_cast<Eigen::Index>(i)] = one.positive[i] ? std::abs(drawn) : drawn;
  }
  return x;
}

// Where machines are drawn from the prior and their days from the machines, the truth has any rank among the draws of
// its posterior as often as any other (Cook, Gelman and Rubin, Journal of Computational and Graphical Statistics 15,
// 2006, 675): of all parameters, whose evidence is correlated, of a sum, and of what a joint would be off by.
TEST(EffectPosterior, TruthHasAnyRankAmongItsDraws) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  EffectEvidence one;
  one.positive = {true, false, true, true, false, true, true};
  one.group = {0, 0, 1, 1, 2, 2, 3};
  one.scale = {0, 1, 2, 2, 3, 4, 5};
  one.known_sd = {0, 0, 0, 0, 0, 0, 0.02};
  const auto count = static_cast<Eigen::Index>(one.group.size());
  // 30 readings by columns that share much, sd 0.01 of each.
  Eigen::MatrixXd columns(30, count);
  for (double& value : columns.reshaped()) value = normal(random);
  columns.col(2) = columns.col(0) + 0.05 * columns.col(2);
  columns.col(5) = columns.col(3) - 0.1 * columns.col(5);
  columns.col(4) *= 0.01;
  columns /= 0.01;
  one.normal = columns.transpose() * columns;
  constexpr int kDays = 300, kRanks = 10;
  Eigen::MatrixXd asked = Eigen::MatrixXd::Identity(count + 2, count);
  asked.row(count).setOnes();
  asked.row(count + 1) << 1.0, -1.0, 0.3, -1.0, 0.1, -0.5, 2.0;
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(asked.rows(), kRanks);
  for (int day = 0; day < kDays; ++day) {
    const Eigen::VectorXd truth = fromPrior(one, random);
    Eigen::VectorXd read = columns * truth;
    for (double& value : read) value += normal(random);
    one.right = columns.transpose() * read;
    constexpr int kDraws = kRanks * 10 - 1, kOneOf = 5;  // ranks are of draws that hardly hang together
    const Eigen::MatrixXd all = drawEffects(one, {kDraws * kOneOf, 1, 200, static_cast<std::uint64_t>(day)});
    const Eigen::MatrixXd some = all(Eigen::all, Eigen::seqN(0, kDraws, kOneOf));
    const Eigen::MatrixXd draws = asked * some;
    const Eigen::VectorXd is = asked * truth;
    for (Eigen::Index row = 0; row < asked.rows(); ++row)
      found(row, (draws.row(row).array() < is[row]).count() * kRanks / (kRanks * 10)) += 1.0;
  }
  for (Eigen::Index row = 0; row < asked.rows(); ++row) {
    const double expected = static_cast<double>(kDays) / kRanks;
    const double chi2 = (found.row(row).array() - expected).square().sum() / expected;
    EXPECT_LT(chi2, 29.7) << "row " << row << ": " << found.row(row);  // one in two thousand of nine degrees of freedom
  }
}

TEST(EffectPosterior, TheSameSeedGivesTheSameDraws) {
  const Eigen::MatrixXd normal = 100.0 * Eigen::MatrixXd::Identity(3, 3);
  const EffectEvidence one = evidence(normal, Eigen::Vector3d(1.0, 0.0, 30.0), {true, false, true});
  EXPECT_EQ(drawEffects(one), drawEffects(one));
  EXPECT_NE(drawEffects(one), drawEffects(one, {1800, 2, 150, 2}));
}

TEST(EffectPosterior, NothingToDraw) { EXPECT_EQ(drawEffects(EffectEvidence{}).rows(), 0); }

}  // namespace
}  // namespace stiffscope::extended_model
