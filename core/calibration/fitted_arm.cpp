#include "core/calibration/fitted_arm.h"

#include <algorithm>
#include <cmath>

#include "metrology/rigid_motion.h"

namespace stiffscope::calibration {

robot::Robot ArmFit::arm(const robot::Robot& nominal) const {
  frames::LoadingGeometry geometry;
  geometry.arm = nominal;
  return frames::moved(geometry, steps, centre).arm;
}

Eigen::Isometry3d ArmFit::basePointsMotion() const {
  const Vector6d base = steps.segment<frames::ArmParameters::kBase>(places().baseAt());
  return metrology::motionAbout(centre, base) * place.base_from_points;
}

std::vector<Eigen::Vector3d> ArmFit::targetsAtZero() const {
  std::vector<Eigen::Vector3d> all = place.targets_at_zero;
  for (std::size_t t = 0; t < all.size(); ++t) all[t] += steps.segment<3>(places().targetAt(t));
  return all;
}

Eigen::Index ArmFit::stationsAt() const {
  return steps.size() + sizes.size() - static_cast<Eigen::Index>(stations.size());
}

double ArmFit::sd(int parameter) const {
  const auto found = std::find(free.begin(), free.end(), parameter);
  if (found == free.end()) return 0.0;
  const auto at = static_cast<Eigen::Index>(found - free.begin());
  return std::sqrt(std::max(0.0, covariance(at, at)));
}

}  // namespace stiffscope::calibration
