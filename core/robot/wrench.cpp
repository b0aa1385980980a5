#include "core/robot/wrench.h"

namespace stiffscope::robot {

JointVector jointTorque(const ArmAxes& axes, const Wrench& wrench_in_base) {
  JointVector torque(static_cast<Eigen::Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const metrology::Line& axis = axes[i];
    torque[static_cast<Eigen::Index>(i)] = axis.direction.dot(wrench_in_base.about(axis.point).moment);
  }
  return axes.torques(torque);
}

JointVector jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base) {
  return jointTorque(axesAt(robot, posture), wrench_in_base);
}

}  // namespace stiffscope::robot
