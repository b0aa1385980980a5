#pragma once

#include <cmath>

#include "metrology/least_squares.h"

namespace stiffscope {

/// Concentric spheres, one a group: residual |p - centre| - r. Shared parameters: the centre. Own: the
/// radius.
struct SpheresModel {
  static constexpr int kShared = 3, kOwn = 1, kResiduals = 1;
  Eigen::Vector3d centre;

  Observation<SpheresModel> observe(std::size_t, const Eigen::Vector3d& point,
                                    const Eigen::Matrix<double, 1, 1>& radius) const {
    long double square = 0.0L;
    for (int k = 0; k < 3; ++k) {
      const long double from = static_cast<long double>(point[k]) - centre[k];
      square += from * from;
    }
    const long double distance = std::sqrt(square);
    Observation<SpheresModel> seen;
    seen.residual << static_cast<double>(distance - radius[0]);
    const Eigen::Vector3d outward = distance > 0.0L
                                        ? Eigen::Vector3d((point - centre) / static_cast<double>(distance))
                                        : Eigen::Vector3d::UnitX();  // at the centre any serves
    seen.rows << -outward.transpose(), -1.0;
    seen.directions = outward;
    return seen;
  }
  void move(const Eigen::Vector3d& step) { centre += step; }
};

}  // namespace stiffscope
