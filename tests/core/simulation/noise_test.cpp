#include <cmath>
#include <limits>
#include <utility>
#include <vector>
#include "core/simulation/instruments.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation_test;
using Eigen::Vector3d;

// Phi(x) = erfc(-x / sqrt 2) / 2 must give p back. Far out, an error of x is magnified by x phi(x)/Phi(x),
// about x^2.
TEST(SimulationRandom, inverseNormalIsTheInverse) {
  for (const double p : {1e-300, 1e-20, 1e-9, 0.001, 0.074, 0.076, 0.3, 0.5, 0.7, 0.93, 0.999, 1.0 - 1e-9}) {
    const double x = numerics::inverseNormal(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / p, 1.0, 1e-15 * (10 + x * x)) << p;
  }
}

// Of the upper tails, whose probabilities are exact: P(above x | between) must give 1 - uniform back.
TEST(SimulationRandom, normalBetweenHasItsShareBelow) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto above = [](double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); };
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{{-kInfinity, kInfinity},
                                                                        {-0.5, 0.2},
                                                                        {-0.2, 0.5},
                                                                        {1.0, 2.0},
                                                                        {-1.0, kInfinity},
                                                                        {8.0, kInfinity},
                                                                        {25.0, 25.01}}) {
    for (const double uniform : {1e-9, 0.01, 0.3, 0.8, 0.999}) {
      const double x = numerics::normalBetween(low, high, uniform);
      EXPECT_NEAR((above(x) - above(high)) / (above(low) - above(high)), 1.0 - uniform, 1e-9) << low << " " << high;
      EXPECT_NEAR(numerics::normalBetween(-high, -low, 1.0 - uniform), -x, 1e-9 * (1.0 + std::abs(x)));
    }
  }
  // Beyond what erfc has: exp(-x^2/2) / x, of which x - low is exponential but for 1/low^2.
  for (const double uniform : {0.01, 0.5, 0.99})
    EXPECT_NEAR(numerics::normalBetween(50.0, kInfinity, uniform), 50.0 - std::log1p(-uniform) / 50.0, 1e-9);
  EXPECT_NEAR(numerics::normalBetween(29.9999999, kInfinity, 0.7), numerics::normalBetween(30.0000001, kInfinity, 0.7),
              1e-4);
  EXPECT_EQ(numerics::normalBetween(2.0, 2.0, 0.3), 2.0);
  EXPECT_EQ(numerics::normalBetween(3.0, 2.0, 0.3), 3.0);
}

TEST(SimulationRandom, streamsAreRepeatableAndIndependent) {
  numerics::RandomStream one(1, "a"), again(1, "a"), other_name(1, "b"), other_seed(2, "a");
  double product_name = 0.0, product_seed = 0.0;
  constexpr int kDraws = 100000;
  for (int n = 0; n < kDraws; ++n) {
    const double x = one.normal();
    ASSERT_EQ(x, again.normal());
    product_name += x * other_name.normal() / kDraws;
    product_seed += x * other_seed.normal() / kDraws;
  }
  // The mean of a product of independent normals has a deviation of 1 / sqrt(100000) = 0.0032; four of them.
  EXPECT_NEAR(product_name, 0.0, 0.0127);
  EXPECT_NEAR(product_seed, 0.0, 0.0127);
}

TEST(SimulationTrackerNoise, hasItsSigmaAlongAndAcrossTheBeam) {
  const campaign::Tracker tracker = armSpec().tracker.declared;
  const Vector3d sight = Vector3d(2.0, -1.0, 0.5).normalized();
  const Vector3d across = sight.unitOrthogonal();
  Eigen::Matrix3d frame;
  frame << sight, across, sight.cross(across);
  const double distance = 3.0, factor = 1.5;
  numerics::RandomStream random(3, "test");
  constexpr int kDraws = 200000;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Vector3d mean = Vector3d::Zero();
  for (int n = 0; n < kDraws; ++n) {
    const Vector3d e = frame.transpose() * simulation::trackerError(tracker, factor, distance * sight, random) * 1e6;
    mean += e / kDraws;
    covariance += e * e.transpose() / kDraws;
  }
  const double along = 1.5 * (4 + 0.6 * 3), sideways = 1.5 * (6 + 2.4 * 3);
  // A sigma from 200,000 draws has a relative deviation of 1/sqrt(400000) = 0.16 %; four of them.
  EXPECT_NEAR(std::sqrt(covariance(0, 0)) / along, 1.0, 0.0064);
  EXPECT_NEAR(std::sqrt(covariance(1, 1)) / sideways, 1.0, 0.0064);
  EXPECT_NEAR(std::sqrt(covariance(2, 2)) / sideways, 1.0, 0.0064);
  EXPECT_NEAR(covariance(0, 1) / (along * sideways), 0.0, 0.009);  // 4 / sqrt(200000)
  EXPECT_NEAR(covariance(1, 2) / (sideways * sideways), 0.0, 0.009);
  EXPECT_LT(mean.norm(), 4.5 * sideways / std::sqrt(1.0 * kDraws));
}

TEST(SimulationLoadCell, readsGainMisalignmentAndBiasUnderLoadOnly) {
  simulation::LoadCellSpec cell;
  cell.misalignment = Vector3d(0, 0, 90 * kDeg);  // the true x axis lies along the declared y
  cell.gain_error = 0.01;
  cell.bias << 5, 0, 0, 0, 0, 0.5;
  campaign::States states;
  states.rows.assign(2, campaign::State(6));
  states.rows[1].wrench_in_cell << 0, 100, 7, 20, 0, 0;
  simulation::addLoadCellErrors(cell, 1, states);
  EXPECT_TRUE(states.rows[0].wrench_in_cell.isZero());
  const Vector6d expected = (Vector6d() << 101 + 5, 0, 7.07, 0, -20.2, 0.5).finished();
  EXPECT_LT((states.rows[1].wrench_in_cell - expected).norm(), 1e-12);  // roundings of 100
}

}  // namespace stiffscope
