#pragma once

#include <array>

#include "core/campaign/campaign.h"
#include "core/frames/measured_axes.h"

namespace stiffscope {

/// Where R0 stands, and the robot's geometry in it: the URDF's with what the sweeps correct.
struct ArmInR0 {
  Robot arm;  ///< its base frame is R0
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();  ///< by the rule on the URDF's axes
  bool points_placed = false;  ///< R0 is known in the frame of the sweeps' readings
  Eigen::Isometry3d r0_from_points = Eigen::Isometry3d::Identity();
};

/// Axes that were swept replace the URDF's; those that were not keep their nominal place in R0. The flange, and
/// what is fixed to it, is carried by the measured axes 5 and 6: it keeps its nominal place in the frame with z along
/// axis 6, x along the part of axis 5 across it, and the origin at the foot of their common perpendicular on axis 6.
ArmInR0 armInR0(const Robot& nominal, const std::array<MeasuredAxis, 6>& axes);

/// The rigid motion that carries the flange from where the nominal axes 5 and 6 put it to where these put it.
Eigen::Isometry3d flangeCarry(const std::array<Line, 6>& nominal, const std::array<Line, 6>& actual);

}  // namespace stiffscope
