#pragma once

#include "core/identification/loading_geometry.h"

namespace stiffscope {

/// Small steps of everything that places the arm: per axis shift_u, shift_v (m), tilt_u, tilt_v (rad); a
/// rigid motion of all readings (rotation vector about `centre`, then shift); each reflector's place at zero
/// (m). Free by choice of frame in part: fits hold them by a wide prior.
struct GeometrySteps {
  static constexpr Eigen::Index kAxes = 24, kBase = 6;
  /// For differences, m and rad: far above rounding, far below where the model curves.
  static constexpr double kSmall = 1e-6;
  static Eigen::Index count(std::size_t targets) {
    return kAxes + kBase + 3 * static_cast<Eigen::Index>(targets);
  }
};

/// The geometry moved by such steps. The flange, and what is fixed to it, follows axes 5 and 6 (see ArmInR0).
LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps,
                      const Eigen::Vector3d& centre);

}  // namespace stiffscope
