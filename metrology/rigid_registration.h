#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace stiffscope {

struct RigidRegistration {
  bool determined = false;
  std::string reason;
  Eigen::Isometry3d to_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;  ///< per coordinate, m
};

/// The proper rigid motion (never a reflection) that brings `source` onto `to` in least squares, point by point.
/// Undetermined: fewer than three points, or points on one line.
RigidRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to);

}  // namespace stiffscope
