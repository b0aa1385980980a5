#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/campaign/campaign.h"
#include "core/frames/joint_axes.h"
#include "core/robot/robot.h"

namespace stiffscope::frames {

/// Where R0 stands, and the robot's geometry in it: the URDF's with what the sweeps correct.
struct ArmInR0 {
  robot::Robot arm;                                                     ///< its base frame is R0
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();  ///< by the rule on the URDF's axes
  bool points_placed = false;  ///< R0 is known in the frame of the sweeps' readings
  Eigen::Isometry3d r0_from_points = Eigen::Isometry3d::Identity();
};

/// Axes that were swept replace the URDF's; those that were not keep their nominal place in R0. The flange, and
/// what is fixed to it, is carried by the last two axes where both are measured (5 and 6 of six; axisAcrossLast): it
/// keeps its nominal place in the frame with z along the last axis, y along the part of the other across it, and the
/// origin at the foot of their common perpendicular on the last.
ArmInR0 armInR0(const robot::Robot& nominal, const MeasuredAxes& axes);

/// The axis that with the last makes the frame that carries the flange: the one before it, or, where that is within a
/// degree of parallel to it, the nearest before that is not. From 0.
std::size_t axisAcrossLast(const robot::ArmAxes& axes);

/// Carries the arm's flange, and what is fixed to it, from where the last two axes of `from` put it to where its own
/// put it.
void carryFlange(const robot::ArmAxes& from, robot::Robot& arm);

/// The rule of the campaign format for R0, on the nominal robot: which way axis 1 and axis 2 are directed to become
/// z0 and y0 (+1: as the joint turns, -1: against it), and where R0 stands.
struct NominalBaseFrame {
  std::array<double, 2> sense{1.0, 1.0};
  Eigen::Isometry3d base_link_from_r0 = Eigen::Isometry3d::Identity();
};

/// z0 on the side of base_link's +z; y0 such that x0 points towards the flange at all joints zero, or, where the
/// flange stands within 50 mm of axis 1 there, in the sense of positive axis 2.
NominalBaseFrame nominalBaseFrame(const robot::Robot& robot);

}  // namespace stiffscope::frames
