#include "core/extended_model/horseshoe.h"

#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace stiffscope::extended_model {
namespace {

/// exp(z) E1(z); from 1 on by its continued fraction, of which the far end hardly matters.
double scaledE1(double z) {
  if (z < 1.0) return -std::exp(z) * std::expint(-z);
  double fraction = 0.0;
  for (int n = 200; n > 0; --n) fraction = n * n / (z + 2.0 * n + 1.0 - fraction);
  return 1.0 / (z + 1.0 - fraction);
}

/// Of s ~ C+(0, 1) the integral over x's density, by hand: with z = S/2 and w = 1/s^2 it is that of
/// w^((n-1)/2) exp(-z w) / (1 + w), up to a constant.
double byHand(std::size_t parameters, double sum) {
  const double z = 0.5 * sum, one = scaledE1(z);
  if (parameters == 1) return one;
  if (parameters == 2)
    return std::sqrt(std::numbers::pi / z) - std::numbers::pi * std::exp(z) * std::erfc(std::sqrt(z));
  return 1.0 / z - one;
}

TEST(ScaleMixture, MarginalIsTheIntegralByHand) {
  for (const std::size_t parameters : {1U, 2U, 3U}) {
    const ScaleMixture mixture(parameters, false);
    const double off = mixture.logMarginal(1.0) - std::log(byHand(parameters, 1.0));
    for (const double sum : {1e-14, 1e-6, 1e-3, 0.02, 0.5, 3.0, 40.0, 200.0})
      EXPECT_NEAR(mixture.logMarginal(sum) - std::log(byHand(parameters, sum)), off, 2e-3) << parameters << " " << sum;
  }
}

// x = l t z of two half Cauchy numbers and a normal one: over l the density is that above with S / t^2, over t by hand.
TEST(ScaleMixture, MarginalOfAProductIsTheIntegralOverItsFactor) {
  for (const std::size_t parameters : {1U, 2U, 3U}) {
    const ScaleMixture mixture(parameters, true);
    const auto byFactor = [&](double sum) {
      double integral = 0.0;
      for (double u = -30.0; u < 30.0; u += 0.01) {
        const double t = std::exp(u);
        if (sum / (t * t) > 1000.0) continue;  // exp(z) overflows; a t as small is out of reach
        integral +=
            byHand(parameters, sum / (t * t)) * std::pow(t, -static_cast<double>(parameters)) * t / (1.0 + t * t);
      }
      return std::log(integral);
    };
    const double off = mixture.logMarginal(1.0) - byFactor(1.0);
    for (const double sum : {1e-8, 1e-4, 0.03, 0.5, 3.0, 30.0})
      EXPECT_NEAR(mixture.logMarginal(sum) - byFactor(sum), off, 0.02) << parameters << " " << sum;
  }
}

TEST(ScaleMixture, JointDensityAddsUpToTheMarginal) {
  for (const bool product : {false, true}) {
    const ScaleMixture mixture(3, product);
    for (const double sum : {1e-9, 1e-2, 7.0}) {
      double integral = 0.0;
      for (double y = -60.0; y < 60.0; y += 0.001) integral += 0.001 * std::exp(mixture.logJoint(sum, y));
      EXPECT_NEAR(std::log(integral), mixture.logMarginal(sum), 2e-3) << product << " " << sum;
    }
  }
}

TEST(ScaleMixture, WhatIsProposedIsNearlyThePosteriorOfTheScale) {
  for (const bool product : {false, true}) {
    for (const std::size_t parameters : {1U, 3U}) {
      const ScaleMixture mixture(parameters, product);
      for (const double sum : {1e-10, 1e-4, 0.1, 20.0}) {
        const PiecewiseDensity proposed = mixture.scaleGiven(sum);
        double apart = 0.0;
        for (double y = -60.0; y < 60.0; y += 0.001) {
          const double is = std::exp(mixture.logJoint(sum, y) - mixture.logMarginal(sum));
          apart += 0.5 * 0.001 * std::abs(is - std::exp(proposed.logDensity(y)));
        }
        EXPECT_LT(apart, 0.03) << product << " " << parameters << " " << sum;
      }
    }
  }
}

TEST(PiecewiseDensity, DrawsFollowIt) {
  std::array<double, PiecewiseDensity::kPlaces> of_normal;
  for (std::size_t i = 0; i < of_normal.size(); ++i) {
    const double x = -4.0 + 0.1 * static_cast<double>(i);
    of_normal[i] = 1e-200 * std::exp(-0.5 * x * x);
  }
  const PiecewiseDensity density(-4.0, 0.1, of_normal);
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  const double least = below(-4.0), whole = below(1.5) - least;
  for (const double uniform : {1e-6, 0.01, 0.3, 0.5, 0.77, 0.999}) {
    const double x = density.draw(uniform);
    EXPECT_NEAR((below(x) - least) / whole, uniform, 1e-3);
    EXPECT_NEAR(std::exp(density.logDensity(x)), std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi) / whole,
                2e-3);
  }
  EXPECT_EQ(density.logDensity(-4.01), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(density.logDensity(1.51), -std::numeric_limits<double>::infinity());
}

// q = t^2 of s = l t has density proportional to 1 / ((q + s^2) (q + 1)).
TEST(FactorOfProduct, InvertsItsDistribution) {
  for (const double square : {1e-8, 0.01, 1.0, 1.0 + 1e-6, 3.0, 1e5}) {
    const auto below = [&](double limit) {
      double sum = 0.0;
      for (double u = -40.0; u < std::log(limit); u += 1e-3) {
        const double q = std::exp(u);
        sum += 1e-3 * q / ((q + square) * (q + 1.0));
      }
      return sum;
    };
    const double whole = below(1e18);
    for (const double uniform : {0.001, 0.2, 0.5, 0.9, 0.999})
      EXPECT_NEAR(below(factorOfProduct(square, uniform)) / whole, uniform, 2e-3) << square;
  }
}

}  // namespace
}  // namespace stiffscope::extended_model
