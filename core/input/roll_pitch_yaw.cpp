#include "core/input/roll_pitch_yaw.h"

#include <Eigen/Geometry>
#include <cmath>

namespace stiffscope {

Eigen::Matrix3d rotationFromRpy(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpyFromRotation(const Eigen::Matrix3d& r) {
  // cos(pitch); below the limit roll and yaw turn about the same line and rounding alone would split them.
  const double across = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), across);
  if (across < 1e-9) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace stiffscope
