#include "core/robot/wrench.h"

namespace stiffscope::robot {

Vector6d jointTorque(const ArmAxes& axes, const Wrench& wrench_in_base) {
  Vector6d torque;
  for (int joint = 0; joint < 6; ++joint) {
    const metrology::Line& axis = axes[static_cast<std::size_t>(joint)];
    torque[joint] = axis.direction.dot(wrench_in_base.about(axis.point).moment);
  }
  return torque;
}

Vector6d jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base) {
  return jointTorque(axesAt(robot, posture), wrench_in_base);
}

}  // namespace stiffscope::robot
