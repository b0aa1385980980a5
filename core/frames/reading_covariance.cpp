#include "core/frames/reading_covariance.h"

namespace stiffscope::frames {

Eigen::Matrix3d readingCovariance(const metrology::TrackerNoise& noise, const Eigen::Isometry3d& r0_from_points,
                                  const Eigen::Vector3d& point_in_r0) {
  const Eigen::Matrix3d turn = r0_from_points.linear();
  return turn * noise.covarianceAt(r0_from_points.inverse() * point_in_r0) * turn.transpose();
}

}  // namespace stiffscope::frames
