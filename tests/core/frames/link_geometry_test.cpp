#include "core/frames/frames.h"

#include <gtest/gtest.h>

// Distances between consecutive axes where these are parallel but for the errors of a machine.

namespace stiffscope {
namespace link_geometry_test {

/// Axes 2, 3 and 4 along y, as of arms of the UR kind: 612.7 and 571.6 mm apart.
robot::Robot threeParallelAxes() {
  robot::Robot robot;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  robot.axes_in_base_at_zero = {metrology::Line{{0.0, 0.0, 0.0}, z},      metrology::Line{{0.0, 0.2, 0.128}, y},
                                metrology::Line{{0.6127, 0.1, 0.128}, y}, metrology::Line{{1.1843, 0.2, 0.128}, y},
                                metrology::Line{{1.1843, 0.3, 0.1}, z},   metrology::Line{{1.3, 0.3, 0.0}, x}};
  return robot;
}

TEST(LinkGeometry, OfThreeParallelAxesIsNearTheUrdf) {
  const robot::Robot nominal = threeParallelAxes();
  frames::ArmInR0 arm;
  arm.arm = nominal;
  const auto tilted = [&](std::size_t axis, double about_x, double about_z) {
    Eigen::Vector3d& direction = arm.arm.axes_in_base_at_zero[axis].direction;
    direction = (direction + Eigen::Vector3d(about_z, 0.0, about_x)).normalized();
  };
  // The common perpendicular of axes 2 and 3 then stands two kilometres away, on axis 3.
  tilted(1, 2e-4, 1e-4);
  tilted(2, -1e-4, 1.003e-4);
  tilted(3, 3e-4, -2e-4);
  const auto links = frames::linkGeometry(nominal, arm);
  EXPECT_NEAR(links[1].nominal_distance, 0.6127, 1e-12);
  EXPECT_NEAR(links[2].nominal_distance, 0.5716, 1e-12);
  // Tilts of half a milliradian over some decimetres along the axes.
  EXPECT_NEAR(links[1].distance, 0.6127, 2e-4);
  EXPECT_NEAR(links[2].distance, 0.5716, 2e-4);
}

}  // namespace link_geometry_test
}  // namespace stiffscope
