#include "core/compensation/elastic_arm.h"

#include <stdexcept>

#include "core/statics/joint_torque.h"

namespace stiffscope {

Vector6d loadedAngles(const LoadingGeometry& geometry, const Vector6d& compliance, const Vector6d& q,
                      const FlangeLoad& load) {
  constexpr int kMostSteps = 100;
  constexpr double kSettled = 1e-12;  // rad
  Vector6d angles = q;
  for (int step = 0; step < kMostSteps; ++step) {
    const ArmPosture posture = postureAt(geometry.arm, angles);
    const Wrench wrench{flangeAt(geometry.arm, posture) * load.point_in_flange, load.force, load.moment};
    const Vector6d torque =
        weightTorque(geometry.arm, posture, geometry.weight) + jointTorque(geometry.arm, posture, wrench);
    const Vector6d next = q + compliance.cwiseProduct(torque);
    const double change = (next - angles).cwiseAbs().maxCoeff();
    angles = next;
    if (change < kSettled) return angles;
  }
  throw std::runtime_error("the loaded arm does not come to rest: the load is too large for these stiffnesses");
}

}  // namespace stiffscope
