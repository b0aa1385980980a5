#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace stiffscope {

/// How a trilaterated point moves with what it is made from.
struct TrilaterationSensitivity {
  std::array<Eigen::Matrix3d, 3> by_points;  ///< by each of the three points, m/m
  Eigen::Matrix3d by_radii;                  ///< a column a radius, m/m
};

/// Of the point P at distances r_k from points p_k, by differentiating |P - p_k|^2 = r_k^2: with unit vectors u_k from
/// p_k to P, u_k . (dP - dp_k) = dr_k, three linear equations for dP. The roots of (13)-(20) satisfy them whichever
/// point is the origin. Empty where P lies in the plane of the three points: there the two roots meet and the
/// derivative has no bound.
std::optional<TrilaterationSensitivity> trilaterationSensitivity(const std::array<Eigen::Vector3d, 3>& points,
                                                                 const Eigen::Vector3d& root);

}  // namespace stiffscope
