#include "core/simulation/rail_beam.h"

#include <gtest/gtest.h>

// A rail as a beam between two supports, against the tables of textbooks (S. P. Timoshenko, Strength of Materials I).

namespace stiffscope {
namespace rail_beam_test {

constexpr double kSpan = 4.0, kUp = 2.0e7, kLevel = 5.0e6, kTwist = 8.0e6;
const simulation::RailBeam kBeam{1.0, 1.0 + kSpan, kUp, kLevel, kTwist};

TEST(RailBeam, SagsInTheMiddleByTheTextbook) {
  const auto compliance = simulation::railCompliance(kBeam, 3.0);
  EXPECT_NEAR(compliance(2, 2) / (kSpan * kSpan * kSpan / (48.0 * kUp)), 1.0, 1e-12);
  EXPECT_NEAR(compliance(1, 1) / (kSpan * kSpan * kSpan / (48.0 * kLevel)), 1.0, 1e-12);
  EXPECT_NEAR(compliance(4, 4) / (kSpan / (12.0 * kUp)), 1.0, 1e-12);  // a moment at mid-span turns by M L / 12 E I
  EXPECT_NEAR(compliance(3, 3) / (kSpan / (4.0 * kTwist)), 1.0, 1e-12);
  EXPECT_EQ(compliance(2, 4), 0.0);  // by symmetry
  EXPECT_EQ(compliance(0, 0), 0.0);
}

// At a quarter, a = 1 m and b = 3 m, 1 kN upwards: w = F a^2 b^2 / (3 E I L) = 9000 / 2.4e8 m = 37.5 um, and the beam
// rises towards the middle by F a b (b - a) / (3 E I L) = 6000 / 2.4e8 = 25 urad: a turn about -y.
TEST(RailBeam, AtAQuarterItTurnsTowardsTheMiddle) {
  const auto compliance = simulation::railCompliance(kBeam, 2.0);
  EXPECT_NEAR(1e3 * compliance(2, 2), 37.5e-6, 1e-15);
  EXPECT_NEAR(1e3 * compliance(4, 2), -25e-6, 1e-15);
  EXPECT_NEAR(compliance(4, 4), (16.0 - 9.0) / 2.4e8, 1e-18);
  EXPECT_NEAR(1e3 * compliance(5, 1), 4.0 * 25e-6, 1e-15);  // level: a quarter as stiff, and about +z
  // Beyond the middle the other way.
  EXPECT_NEAR(simulation::railCompliance(kBeam, 4.0)(4, 2), -compliance(4, 2), 1e-18);
}

// By integration of the bending moment instead of the formulas: w'' = M(x) / E I over the beam under a moment at a,
// supports' reactions M / L; w found from w(0) = w(L) = 0 by the trapezoidal rule in 1e5 steps.
TEST(RailBeam, UnderAMomentIsWhatItsCurvatureAddsUpTo) {
  const double a = 1.3;
  constexpr int kSteps = 100000;
  const double step = kSpan / kSteps;
  double slope = 0.0, w = 0.0, slope_at = 0.0, w_at = 0.0;
  const auto curvature = [&](double x) { return (x < a ? -x / kSpan : 1.0 - x / kSpan) / kUp; };
  for (int k = 0; k < kSteps; ++k) {
    const double x = k * step;
    const double next = slope + 0.5 * step * (curvature(x) + curvature(x + step));
    w += 0.5 * step * (slope + next);
    slope = next;
    if (x + step <= a + 0.5 * step) slope_at = slope, w_at = w;
  }
  const double start = -w / kSpan;  // slope at the first support
  const auto compliance = simulation::railCompliance(kBeam, kBeam.from + a);
  // A moment that turns the beam towards larger w at larger x: here -M_y and -r_y.
  EXPECT_NEAR((slope_at + start) / -compliance(4, 4), 1.0, 1e-4);
  EXPECT_NEAR((w_at + start * a) / compliance(2, 4), 1.0, 1e-4);
}

TEST(RailBeam, ItsStiffnessIsTheInverse) {
  const auto compliance = simulation::railCompliance(kBeam, 1.7), stiffness = simulation::railStiffness(kBeam, 1.7);
  const Eigen::Matrix<double, 5, 5> product =
      compliance.bottomRightCorner<5, 5>() * stiffness.bottomRightCorner<5, 5>();
  EXPECT_LT((product - Eigen::Matrix<double, 5, 5>::Identity()).norm(), 1e-12);
}

TEST(RailBeam, CarriesBetweenItsSupportsOnly) {
  EXPECT_TRUE(simulation::carries(kBeam, 3.0));
  EXPECT_FALSE(simulation::carries(kBeam, 1.0));
  EXPECT_FALSE(simulation::carries(kBeam, 0.5));
  EXPECT_FALSE(simulation::carries(kBeam, 5.5));
}

}  // namespace rail_beam_test
}  // namespace stiffscope
