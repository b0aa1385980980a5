#include "metrology/rigid_motion.h"

#include <Eigen/SVD>

#include "metrology/lines.h"

namespace stiffscope::metrology {

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0).finished();
}

NearestRotation nearestRotation(const Eigen::Matrix3d& map) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(map, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  return {svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), svd.singularValues()};
}

Eigen::Isometry3d baseFrame(const Line& axis_1, const Line& axis_2) {
  const Eigen::Vector3d z = axis_1.direction.normalized();
  const Eigen::Vector3d y = (axis_2.direction - z.dot(axis_2.direction) * z).normalized();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() << y.cross(z), y, z;
  frame.translation() = commonPerpendicular(axis_1, axis_2).foot_on_first;
  return frame;
}

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

Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Eigen::Matrix<double, 6, 1>& motion) {
  const Eigen::Vector3d turn = motion.head<3>();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0.0) result.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  result.translation() = centre + motion.tail<3>() - result.linear() * centre;
  return result;
}

}  // namespace stiffscope::metrology
