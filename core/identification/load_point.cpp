#include "core/identification/load_point.h"

#include <Eigen/Dense>

namespace stiffscope::identification {

Eigen::Matrix3d momentByPoint(const Eigen::Vector3d& force) {  // d x F = -F x d
  Eigen::Matrix3d m;
  m << 0.0, force.z(), -force.y(), -force.z(), 0.0, force.x(), force.y(), -force.x(), 0.0;
  return m;
}

LoadPointFit::LoadPointFit(const std::vector<ToolLoad>& loads) {
  for (const ToolLoad& one : loads) {
    const Eigen::Matrix3d by_point = momentByPoint(one.force);
    normal_ += by_point.transpose() * by_point;
    right_ += by_point.transpose() * one.moment;
  }
}

Eigen::Vector3d LoadPointFit::point(double prior) const {
  Eigen::Matrix3d held = normal_;
  held.diagonal().array() += prior;
  return held.ldlt().solve(right_);
}

}  // namespace stiffscope::identification
