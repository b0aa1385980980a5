#include "core/effects/elastic_arm.h"

#include "core/robot/wrench.h"

namespace stiffscope::effects {

std::optional<Vector6d> loadedAngles(const frames::LoadingGeometry& geometry, const Vector6d& compliance,
                                     const Vector6d& q, const FlangeLoad& load) {
  constexpr int kMostSteps = 100;
  constexpr double kSettled = 1e-12;  // rad
  Vector6d angles = q;
  for (int step = 0; step < kMostSteps; ++step) {
    const robot::ArmPosture posture = robot::postureAt(geometry.arm, angles);
    const robot::Wrench wrench{robot::flangeAt(geometry.arm, posture) * load.point_in_flange, load.force, load.moment};
    const Vector6d torque =
        robot::weightTorque(geometry.arm, posture, geometry.weight) + robot::jointTorque(geometry.arm, posture, wrench);
    const Vector6d next = q + compliance.cwiseProduct(torque);
    const double change = (next - angles).cwiseAbs().maxCoeff();
    angles = next;
    if (change < kSettled) return angles;
  }
  return std::nullopt;
}

}  // namespace stiffscope::effects
