#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/robot/robot.h"

namespace stiffscope {

/// The rule of the campaign format for R0, on the nominal robot: which way axis 1 and axis 2 are directed to become
/// z0 and y0 (+1: as the joint turns, -1: against it), and where R0 stands.
struct NominalBaseFrame {
  std::array<double, 2> sense{1.0, 1.0};
  Eigen::Isometry3d base_link_from_r0 = Eigen::Isometry3d::Identity();
};

/// z0 on the side of base_link's +z; y0 such that x0 points towards the flange at all joints zero, or, where the
/// flange stands within 50 mm of axis 1 there, in the sense of positive axis 2.
NominalBaseFrame nominalBaseFrame(const Robot& robot);

}  // namespace stiffscope
