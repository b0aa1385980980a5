#include "core/campaign/campaign.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::campaign {

Eigen::Matrix3d StationPlace::covarianceAt(const Eigen::Vector3d& point_in_first) const {
  Eigen::Matrix<double, 3, 6> by_motion;
  by_motion << -metrology::crossMatrix(point_in_first - centre), Eigen::Matrix3d::Identity();
  return by_motion * covariance * by_motion.transpose();
}

}  // namespace stiffscope::campaign
