#include "core/robot/wrench.h"

namespace stiffscope::robot {

JointVector jointTorque(const ArmAxes& axes, const Wrench& wrench_in_base) {
  JointVector torque(static_cast<Eigen::Index>(axes.size()));
  for (std::size_t joint = 0; joint < axes.size(); ++joint) {
    const metrology::Line& axis = axes[joint];
    torque[static_cast<Eigen::Index>(joint)] = axis.direction.dot(wrench_in_base.about(axis.point).moment);
  }
  return torque;
}

JointVector jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base) {
  return jointTorque(axesAt(robot, posture), wrench_in_base);
}

}  // namespace stiffscope::robot
