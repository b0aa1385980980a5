#pragma once

#include <Eigen/Core>
#include <vector>

namespace stiffscope::identification {

/// A force and its moment about one point of the tool, in axes that turn with the tool, N and Nm.
struct ToolLoad {
  Eigen::Vector3d force, moment;
};

/// The matrix L with L d = d x F: the moment of a force at d, linear in d.
Eigen::Matrix3d momentByPoint(const Eigen::Vector3d& force);

/// Where a load hangs or pulls: the point d through which all loads pass as nearly as can be, M = d x F, by least
/// squares, in the axes and from the point of the loads, m.
class LoadPointFit {
 public:
  explicit LoadPointFit(const std::vector<ToolLoad>& loads);

  /// Sum of L^T L, N^2; singular where all forces lie along one line in the tool, which leaves d open along it.
  const Eigen::Matrix3d& normal() const { return normal_; }

  /// d. `prior` (N^2) holds each coordinate at zero with that weight, as for directions that the loads leave open.
  Eigen::Vector3d point(double prior = 0.0) const;

 private:
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

}  // namespace stiffscope::identification
