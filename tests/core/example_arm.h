#pragma once
#include "core/robot/kinematics.h"

namespace stiffscope {

/// An arm of the size of a FANUC M-900iB/700, built by hand: base frame at the floor, axes at zero as its data sheet
/// draws them, masses round numbers.
inline robot::Robot exampleArm() {
  robot::Robot arm;
  arm.name = "example";
  arm.axes_in_base_at_zero = {metrology::Line{{0, 0, 0.94}, {0, 0, 1}},       metrology::Line{{0.41, 0, 0.94}, {0, 1, 0}},
                              metrology::Line{{0.41, 0, 2.06}, {0, -1, 0}},   metrology::Line{{0.41, 0, 2.31}, {-1, 0, 0}},
                              metrology::Line{{1.695, 0, 2.31}, {0, -1, 0}},  metrology::Line{{1.995, 0, 2.31}, {-1, 0, 0}}};
  for (robot::JointLimits& limits : arm.limits) limits = {-3.2, 3.2};
  arm.base_from_flange_at_zero.linear() << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  arm.base_from_flange_at_zero.translation() << 1.995, 0, 2.31;
  const double masses[7] = {0, 1000, 550, 650, 160, 60, 15};
  const Eigen::Vector3d centres[7] = {{0, 0, 0},         {0.15, 0, 0.7},   {0.41, 0, 1.5}, {0.3, 0, 2.2},
                                      {1.1, 0, 2.31}, {1.75, 0, 2.31}, {1.995, 0, 2.31}};
  for (std::size_t i = 0; i < 7; ++i) arm.bodies[i] = {masses[i], centres[i]};
  arm.links = {{"base_link", 0, Eigen::Isometry3d::Identity()}, {"tool0", 6, arm.base_from_flange_at_zero}};
  return arm;
}

}  // namespace stiffscope
