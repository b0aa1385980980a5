#include "core/identification/wrist_leak.h"

namespace stiffscope {

double wristLeak(const LoadedArm& arm, const Eigen::Vector3d& centre_at_zero, const Vector6d& compliance) {
  Vector6d wrist_only = compliance;
  wrist_only.head<3>().setZero();
  double leak = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < arm.wrist.size(); ++i) {
    // The wrist centre where the arm's geometry has it, so that only the axes' miss counts.
    const Eigen::Vector3d centre = modelledWrist(arm.geometry.arm, arm.cases[i], centre_at_zero);
    leak += (pointRows(jacobianAxes(arm.cases[i]), centre, arm.torques[i]) * wrist_only).norm();
    whole += arm.wrist[i].displacement().norm();
  }
  return whole > 0.0 ? leak / whole : 0.0;
}

}  // namespace stiffscope
