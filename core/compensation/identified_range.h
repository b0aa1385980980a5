#pragma once

#include <vector>

#include "core/frames/arm_geometry.h"
#include "core/identification/identification.h"
#include "core/robot/wrench.h"

namespace stiffscope::compensation {

/// The loads and postures that a day's stiffnesses come from, and what the model left of the day's own deflections.
struct IdentifiedRange {
  double force = 0.0;                                        ///< largest, N
  double moment = 0.0;                                       ///< largest about the wrist, Nm
  Vector6d torque = Vector6d::Zero();                        ///< largest of each joint by the load, Nm
  Vector6d low = Vector6d::Zero(), high = Vector6d::Zero();  ///< joint angles, rad
  double model_error = 0.0;  ///< rms per coordinate of a reflector, beyond noise, under the largest load, m
  double tool_size = 0.0;    ///< rms distance of the reflectors from their middle, m
};

/// Of one method's load cases.
///
/// Model error: every posture is left out once (of more than 50, a fiftieth of them at a time), the springs are solved
/// from the others, effects as they are, and s^2 = (sum r^2 - n noise^2) / sum of load^2 over the reflectors' residuals
/// r of postures left out; never below zero. Load: as loadRatio.
IdentifiedRange identifiedRange(const identification::Identification& result, identification::Method method);

/// Where axes 5 and 6 come nearest to each other: what moments of a load are taken about.
Eigen::Vector3d wristOf(const robot::ArmAxes& axes);

/// How large a load is beside the largest of the day: the larger of the ratios of force and of moment about the wrist.
double loadRatio(const IdentifiedRange& range, const robot::Wrench& wrench, const robot::ArmAxes& axes);

}  // namespace stiffscope::compensation
