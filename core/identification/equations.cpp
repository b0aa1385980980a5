#include "core/identification/equations.h"

#include "core/robot/kinematics.h"
#include "core/statics/geometric_stiffness.h"
#include "core/statics/joint_torque.h"

namespace stiffscope {

std::vector<Vector6d> jointTorques(const LoadingGeometry& geometry, const std::vector<LoadCase>& cases) {
  std::vector<Vector6d> torques;
  torques.reserve(cases.size());
  for (const LoadCase& load_case : cases) {
    torques.push_back(jointTorque(geometry.arm, load_case.posture, load_case.wrench));
  }
  return torques;
}

std::vector<Vector6d> jointTorquesWithGeometricStiffness(const LoadingGeometry& geometry,
                                                         const std::vector<LoadCase>& cases,
                                                         const Vector6d& compliance) {
  std::vector<Vector6d> torques = jointTorques(geometry, cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Matrix6d change = geometricStiffness(geometry.arm, cases[i].posture, cases[i].wrench) +
                            geometricStiffness(geometry.arm, cases[i].posture, geometry.weight);
    // Springs' torque s solves s = tau + K_c c s.
    const Matrix6d system = Matrix6d::Identity() - change * compliance.asDiagonal();
    torques[i] = system.partialPivLu().solve(torques[i]).eval();
  }
  return torques;
}

void turnWrenches(const LoadingGeometry& geometry, const Vector6d& compliance,
                  const std::vector<Vector6d>& torques, std::vector<LoadCase>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    LoadCase& load_case = cases[i];
    if (load_case.wrench_turns_with == 0) continue;
    const auto body = static_cast<std::size_t>(load_case.wrench_turns_with);
    const ArmPosture loaded =
        postureAt(geometry.arm, load_case.q_sagged + compliance.cwiseProduct(torques[i]));
    const Eigen::Matrix3d turn =
        loaded.motion[body].linear() * load_case.posture.motion[body].linear().transpose();
    load_case.wrench.force = turn * load_case.wrench_unturned.force;
    load_case.wrench.moment = turn * load_case.wrench_unturned.moment;
  }
}

void takeJacobiansAtMiddle(const LoadingGeometry& geometry, const Vector6d& compliance,
                           const std::vector<Vector6d>& torques, std::vector<LoadCase>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].middle = postureAt(geometry.arm, cases[i].q_sagged + 0.5 * compliance.cwiseProduct(torques[i]));
  }
}

Matrix36d pointRows(const LoadingGeometry& geometry, const LoadCase& load_case, const Eigen::Vector3d& point,
                    const Vector6d& torque) {
  return jacobianAt(geometry.arm, jacobianPosture(load_case), point).topRows<3>() * torque.asDiagonal();
}

}  // namespace stiffscope
