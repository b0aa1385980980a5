#include "core/identification/arm_normal.h"

#include "core/parallel/sum_in_blocks.h"

namespace stiffscope {

NormalEquations reflectorNormal(const LoadedArm& arm) {
  return sumInBlocks<NormalEquations>(arm.cases.size(), [&](std::size_t i, NormalEquations& sum) {
    const LoadCase& load_case = arm.cases[i];
    const ArmAxes& axes = jacobianAxes(load_case);
    for (const TargetMove& move : load_case.targets) {
      const Eigen::Vector3d point = jacobianPoint(load_case, move.unloaded, move.loaded);
      sum.add(pointRows(axes, point, arm.torques[i]), move.displacement());
    }
  });
}

NormalEquations wristNormal(const LoadedArm& arm) {
  return sumInBlocks<NormalEquations>(arm.wrist.size(), [&](std::size_t i, NormalEquations& sum) {
    const WristMove& move = arm.wrist[i];
    const Eigen::Vector3d point = jacobianPoint(arm.cases[i], move.unloaded, move.loaded);
    sum.add(pointRows(jacobianAxes(arm.cases[i]), point, arm.torques[i]), move.displacement());
  });
}

PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange) {
  return sumInBlocks<PoseNormal>(arm.cases.size(), [&](std::size_t i, PoseNormal& sum) {
    sum.add(completePoseEquations(arm.cases[i], tcp_in_flange, arm.torques[i]));
  });
}

}  // namespace stiffscope
