#include "metrology/trilateration_sensitivity.h"

#include <Eigen/LU>
#include <cmath>

namespace stiffscope {

std::optional<TrilaterationSensitivity> trilaterationSensitivity(const std::array<Eigen::Vector3d, 3>& points,
                                                                 const Eigen::Vector3d& root) {
  constexpr double kInPlane = 1e-9;  // of the volume that the three unit vectors span
  Eigen::Matrix3d outward;
  for (int k = 0; k < 3; ++k) {
    outward.row(k) = (root - points[static_cast<std::size_t>(k)]).normalized().transpose();
  }
  if (!(std::abs(outward.determinant()) > kInPlane)) return std::nullopt;
  TrilaterationSensitivity sensitivity;
  sensitivity.by_radii = outward.inverse();
  for (int k = 0; k < 3; ++k) {
    sensitivity.by_points[static_cast<std::size_t>(k)] = sensitivity.by_radii.col(k) * outward.row(k);
  }
  return sensitivity;
}

}  // namespace stiffscope
