#include "core/diagnosis/probed_motion.h"

#include <Eigen/Geometry>

namespace stiffscope {

std::vector<Eigen::Vector3d> probesAt(const Eigen::Vector3d& first) {
  return {first, first + Eigen::Vector3d::UnitX(), first + Eigen::Vector3d::UnitY(),
          first + Eigen::Vector3d::UnitZ()};
}

Vector6d probedMotion(const Eigen::VectorXd& moved) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    turn += 0.5 * Eigen::Vector3d::Unit(k).cross(moved.segment<3>(3 * (k + 1)) - moved.head<3>());
  return (Vector6d() << turn, moved.head<3>()).finished();
}

}  // namespace stiffscope
