#include "core/toolpath/tool_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stiffscope {
namespace cutting_force_test {

using std::numbers::pi;

/// 0.4 mm a revolution, 3 mm deep, 12 of 20 mm wide, 800 N/mm^2.
toolpath::Cutting someCut() {
  toolpath::Cutting cutting;
  cutting.feed = 0.4e-3;
  cutting.depth = 3e-3;
  cutting.width = 12e-3;
  cutting.diameter = 20e-3;
  cutting.specific_force = 800e6;
  cutting.radial_ratio = 0.35;
  cutting.axial_ratio = 0.1;
  return cutting;
}

// Half a turn of the sines by hand: F_x = -a f K_r / 4, F_y = a f K_t / 4, F_z = -a f K_a / pi.
TEST(CuttingForce, OfASlotByHand) {
  toolpath::Cutting slot = someCut();
  slot.width = slot.diameter;
  const double unit = 800e6 * 3e-3 * 0.4e-3;
  for (const bool up : {false, true}) {
    slot.up = up;
    const toolpath::CuttingForce found = toolpath::meanCuttingForce(slot);
    EXPECT_NEAR(found.force.x(), -0.35 * unit / 4.0, 1e-9);
    EXPECT_NEAR(found.force.y(), unit / 4.0, 1e-9);
    EXPECT_NEAR(found.force.z(), -0.1 * unit / pi, 1e-9);
    EXPECT_NEAR(found.torque, 800e6 * 3e-3 * 20e-3 * 0.4e-3 / (2.0 * pi), 1e-12);
  }
}

/// The same from chips: each tooth's forces turned into the axes of the feed, added up over a revolution by the
/// midpoint rule, for so many teeth.
toolpath::CuttingForce summed(const toolpath::Cutting& cutting, int teeth) {
  const double radius = 0.5 * cutting.diameter, chip = cutting.feed / teeth;
  constexpr int kSteps = 200000;
  toolpath::CuttingForce mean;
  for (int step = 0; step < kSteps; ++step) {
    const double phi = 2.0 * pi * (step + 0.5) / kSteps;
    // Seen from the spindle, x forward, y to the left; the tooth goes clockwise from y, so it is at (sin, cos).
    const Eigen::Vector3d outward(std::sin(phi), std::cos(phi), 0.0), along(std::cos(phi), -std::sin(phi), 0.0);
    // Material that is left: across the feed from where the cutter's rim leaves width uncut on the other side.
    const double y = radius * outward.y(), low = cutting.up ? radius - cutting.width : -radius;
    const bool cuts = outward.x() > 0.0 && y > low && y < low + cutting.width;
    if (!cuts) continue;
    const double area = cutting.depth * chip * std::sin(phi), tangential = cutting.specific_force * area;
    mean.force += teeth *
                  (-tangential * along - cutting.radial_ratio * tangential * outward -
                   cutting.axial_ratio * tangential * Eigen::Vector3d::UnitZ()) /
                  kSteps;
    mean.torque += teeth * tangential * radius / kSteps;
  }
  return mean;
}

TEST(CuttingForce, IsTheMeanOfTheTeethsForces) {
  for (const bool up : {false, true}) {
    for (const double width : {1e-3, 7e-3, 12e-3, 19e-3}) {
      toolpath::Cutting cutting = someCut();
      cutting.up = up;
      cutting.width = width;
      const toolpath::CuttingForce found = toolpath::meanCuttingForce(cutting);
      for (const int teeth : {1, 4}) {
        const toolpath::CuttingForce sum = summed(cutting, teeth);
        // The rule misses the ends of the cut by one step of 2e5: 1e-5 of some 300 N.
        EXPECT_LT((found.force - sum.force).norm(), 1e-2) << up << " " << width;
        EXPECT_NEAR(found.torque, sum.torque, 1e-4);
      }
    }
  }
}

// The spindle's power is k_c times the volume removed in a second.
TEST(CuttingForce, TorqueIsThePowerOfTheVolumeRemoved) {
  const toolpath::Cutting cutting = someCut();
  constexpr double kRevolutions = 100.0;  // a second
  const double volume = cutting.width * cutting.depth * cutting.feed * kRevolutions;
  const double power = toolpath::meanCuttingForce(cutting).torque * 2.0 * pi * kRevolutions;
  EXPECT_NEAR(power, cutting.specific_force * volume, 1e-9 * power);
}

// Climb milling pushes the cutter away from the part (to the left, which is where it has nothing), conventional milling
// of a thin cut draws it in against the feed.
TEST(CuttingForce, DirectionsOfThinCuts) {
  toolpath::Cutting thin = someCut();
  thin.width = 1e-3;
  const toolpath::CuttingForce down = toolpath::meanCuttingForce(thin);
  EXPECT_GT(down.force.y(), 0.0);
  EXPECT_GT(down.force.x(), 0.0);  // with the feed
  thin.up = true;
  EXPECT_LT(toolpath::meanCuttingForce(thin).force.x(), 0.0);  // against it
}

}  // namespace cutting_force_test
}  // namespace stiffscope
