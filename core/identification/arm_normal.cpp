#include "core/identification/arm_normal.h"

namespace stiffscope {

NormalEquations reflectorNormal(const LoadedArm& arm) {
  NormalEquations sum;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    const LoadCase& load_case = arm.cases[i];
    const ArmAxes axes = jacobianAxes(arm.geometry, load_case);
    for (const TargetMove& move : load_case.targets) {
      const Eigen::Vector3d point = jacobianPoint(load_case, move.unloaded, move.loaded);
      sum.add(pointRows(axes, point, arm.torques[i]), move.displacement());
    }
  }
  return sum;
}

NormalEquations wristNormal(const LoadedArm& arm) {
  NormalEquations sum;
  for (std::size_t i = 0; i < arm.wrist.size(); ++i) {
    const WristMove& move = arm.wrist[i];
    const Eigen::Vector3d point = jacobianPoint(arm.cases[i], move.unloaded, move.loaded);
    sum.add(pointRows(jacobianAxes(arm.geometry, arm.cases[i]), point, arm.torques[i]), move.displacement());
  }
  return sum;
}

PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  PoseNormal sum;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    sum.add(completePoseEquations(arm.geometry, arm.cases[i], tcp_in_flange, arm.torques[i]));
  }
  return sum;
}

}  // namespace stiffscope
