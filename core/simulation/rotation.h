#pragma once

#include <Eigen/Geometry>

#include "metrology/lines.h"

// Finite rotations of the simulated machine. A rotation vector v turns by |v| about v/|v|, right-handed.

namespace stiffscope::simulation {

Eigen::Matrix3d skew(const Eigen::Vector3d& v);  ///< skew(v) x = v cross x

/// Exp(v) = I + sin a / a [v] + (1 - cos a) / a^2 [v]^2, a = |v|; exact to rounding at every a, zero
/// included.
Eigen::Matrix3d rotationExp(const Eigen::Vector3d& v);

/// J_l(v) = I + (1 - cos a) / a^2 [v] + (a - sin a) / a^3 [v]^2: Exp(v + dv) = Exp(J_l(v) dv) Exp(v) to first
/// order. A moment m (axes before the rotation) is conjugate to v as J_l(v)^T m.
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v);

/// The rigid motion that turns by `angle` (rad) about the directed line.
Eigen::Isometry3d turnAbout(const metrology::Line& axis, double angle);

/// The rigid motion that turns by the rotation vector about a fixed point.
Eigen::Isometry3d turnAbout(const Eigen::Vector3d& point, const Eigen::Vector3d& rotation_vector);

/// A frame at `origin` whose z axis is along `direction` (any length > 0); x and y are chosen reproducibly.
Eigen::Isometry3d frameAlong(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace stiffscope::simulation
