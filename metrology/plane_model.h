#pragma once

#include "metrology/axis_frame.h"
#include "metrology/finish_fit.h"

namespace stiffscope {

/// Parallel planes, one a group: residual n.p - height. Shared parameters: tilts of the normal towards u and
/// v.
struct PlanesModel {
  static constexpr int kShared = 2, kOwn = 1, kResiduals = 1;
  AxisFrame normal;  ///< through the local origin

  Observation<PlanesModel> observe(std::size_t, const Eigen::Vector3d& point,
                                   const Eigen::Matrix<double, 1, 1>& height) const {
    Observation<PlanesModel> seen;
    seen.residual << static_cast<double>(normal.heightOf(point) - height[0]);
    seen.rows << normal.u().dot(point), normal.v().dot(point), -1.0;
    seen.directions = normal.direction();
    return seen;
  }
  void move(const Eigen::Vector2d& step) { normal.move({0.0, 0.0, step[0], step[1]}); }
};

}  // namespace stiffscope
