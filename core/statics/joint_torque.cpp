#include "core/statics/joint_torque.h"

namespace stiffscope {

Vector6d jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base) {
  return jacobianAt(robot, posture, wrench_in_base.point).transpose() * wrench_in_base.vector();
}

}  // namespace stiffscope
