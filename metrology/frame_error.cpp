#include "metrology/frame_error.h"

namespace stiffscope {

FrameError frameError(const Eigen::Isometry3d& in_from_true, const Eigen::Isometry3d& in_from_measured) {
  const Eigen::Isometry3d true_from_measured = in_from_true.inverse() * in_from_measured;
  const Eigen::Quaterniond turn(true_from_measured.linear());
  // Twice the vector part is the rotation vector to third order, and keeps every digit of a small one.
  FrameError error;
  error << (turn.w() < 0.0 ? -2.0 : 2.0) * turn.vec(), true_from_measured.translation();
  return error;
}

Eigen::Matrix<double, 3, 6> vectorByFrameError(const Eigen::Vector3d& d) {
  Eigen::Matrix<double, 3, 6> by = Eigen::Matrix<double, 3, 6>::Zero();
  by.leftCols<3>() << 0.0, -d.z(), d.y(), d.z(), 0.0, -d.x(), -d.y(), d.x(), 0.0;  // d x rotation
  return by;
}

Eigen::Matrix<double, 3, 6> pointByFrameError(const Eigen::Vector3d& x) {
  Eigen::Matrix<double, 3, 6> by = vectorByFrameError(x);
  by.rightCols<3>() = -Eigen::Matrix3d::Identity();
  return by;
}

}  // namespace stiffscope
