#include "core/identification/equations.h"

#include <Eigen/LU>

#include "core/parallel/on_all_cores.h"
#include "core/robot/kinematics.h"
#include "core/statics/geometric_stiffness.h"
#include "core/statics/joint_torque.h"

namespace stiffscope {

namespace {

/// By how K_c turns torques into torques, K_c c; the own weight's part depends on the posture alone.
class SpringTorque {
 public:
  SpringTorque(const LoadingGeometry& geometry, const LoadCase& load_case, const Vector6d& compliance)
      : axes_(load_case.axes), compliance_(compliance) {
    if (geometry.weight.any()) {
      by_weight_ = geometricStiffness(axes_, unloadedPosture(geometry.arm, load_case), geometry.weight);
    }
  }

  /// Solves s = tau + K_c c s.
  Vector6d under(const Wrench& wrench) const {
    const Matrix6d change = geometricStiffness(axes_, wrench) + by_weight_;
    const Matrix6d system = Matrix6d::Identity() - change * compliance_.asDiagonal();
    return system.partialPivLu().solve(jointTorque(axes_, wrench));
  }

 private:
  const ArmAxes& axes_;
  Matrix6d by_weight_ = Matrix6d::Zero();
  const Vector6d& compliance_;
};

/// The wrench as the model's turn of its body by these joint angles directs it.
Wrench turnedWrench(const Robot& arm, const LoadCase& load_case, const Vector6d& loaded) {
  const auto body = static_cast<std::size_t>(load_case.wrench_turns_with);
  const Eigen::Matrix3d turn = postureAt(arm, loaded).motion[body].linear() * load_case.unturned.transpose();
  return {load_case.wrench.point, turn * load_case.wrench_unturned.force,
          turn * load_case.wrench_unturned.moment};
}

ArmAxes middleOf(const Robot& arm, const LoadCase& load_case, const Vector6d& compliance,
                 const Vector6d& torque) {
  return axesAt(arm, postureAt(arm, load_case.q_sagged + 0.5 * compliance.cwiseProduct(torque)));
}

}  // namespace

std::vector<Vector6d> jointTorques(const std::vector<LoadCase>& cases) {
  std::vector<Vector6d> torques(cases.size());
  smallWorkOnAllCores(cases.size(),
                      [&](std::size_t i) { torques[i] = jointTorque(cases[i].axes, cases[i].wrench); });
  return torques;
}

std::vector<Vector6d> jointTorquesWithGeometricStiffness(const LoadingGeometry& geometry,
                                                         const std::vector<LoadCase>& cases,
                                                         const Vector6d& compliance) {
  std::vector<Vector6d> torques(cases.size());
  smallWorkOnAllCores(cases.size(), [&](std::size_t i) {
    torques[i] = SpringTorque(geometry, cases[i], compliance).under(cases[i].wrench);
  });
  return torques;
}

void settleLoads(const LoadingGeometry& geometry, const Vector6d& compliance, std::vector<LoadCase>& cases,
                 std::vector<Vector6d>& torques) {
  torques.resize(cases.size());
  smallWorkOnAllCores(cases.size(), [&](std::size_t i) {
    LoadCase& load_case = cases[i];
    const SpringTorque springs(geometry, load_case, compliance);
    torques[i] = springs.under(load_case.wrench);
    if (load_case.wrench_turns_with != 0) {
      load_case.wrench =
          turnedWrench(geometry.arm, load_case, load_case.q_sagged + compliance.cwiseProduct(torques[i]));
      torques[i] = springs.under(load_case.wrench);
    }
    load_case.middle = middleOf(geometry.arm, load_case, compliance, torques[i]);
  });
}

void takeJacobiansAtMiddle(const LoadingGeometry& geometry, const Vector6d& compliance,
                           const std::vector<Vector6d>& torques, std::vector<LoadCase>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].middle = middleOf(geometry.arm, cases[i], compliance, torques[i]);
  }
}

Matrix36d pointRows(const ArmAxes& axes, const Eigen::Vector3d& point, const Vector6d& torque) {
  return pointJacobianAt(axes, point) * torque.asDiagonal();
}

}  // namespace stiffscope
