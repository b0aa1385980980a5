#include "core/simulation/postures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace stiffscope::simulation {
namespace posture_spacing_test {

/// A box whose third joint stands still.
const JointVector kLow = (Vector6d() << -1.0, -0.5, 0.3, -2.0, -3.0, 0.0).finished();
const JointVector kHigh = (Vector6d() << 1.0, 0.5, 0.3, 2.0, 3.0, 0.5).finished();

JointVector draw(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share;
  JointVector q(6);
  for (int i = 0; i < 6; ++i) q[i] = kLow[i] + share(random) * (kHigh[i] - kLow[i]);
  return q;
}

double squaredByHand(const JointVector& a, const JointVector& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    if (i == 2) continue;
    const double apart = (a[i] - b[i]) / (kHigh[i] - kLow[i]);
    sum += apart * apart;
  }
  return sum;
}

TEST(PostureSpacing, WithoutAnyIsInfinite) {
  EXPECT_EQ(simulation::PostureSpacing(kLow, kHigh).squaredToNearest(kLow, 0.0),
            std::numeric_limits<double>::infinity());
}

TEST(PostureSpacing, IsTheLeastOfAllDistances) {
  simulation::PostureSpacing spacing(kLow, kHigh);
  std::vector<JointVector> before;
  std::mt19937_64 random(3);
  for (int n = 0; n < 600; ++n) {
    const JointVector q = draw(random);
    double least = std::numeric_limits<double>::infinity();
    for (const JointVector& one : before) least = std::min(least, squaredByHand(q, one));
    EXPECT_EQ(spacing.squaredToNearest(q, 0.0), least) << n;  // the same sum of the same numbers
    // Where the nearest is near enough, some posture that is; else the nearest.
    const double enough = 0.05, found = spacing.squaredToNearest(q, enough);
    EXPECT_EQ(found <= enough, least <= enough) << n;
    if (least > enough) {
      EXPECT_EQ(found, least) << n;
    }
    before.push_back(q);
    spacing.add(q);
  }
}

}  // namespace posture_spacing_test
}  // namespace stiffscope::simulation
