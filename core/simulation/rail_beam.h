#pragma once

#include <Eigen/Core>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Compliance and stiffness of a rail where its carriage stands, between what the ground holds and what the carriage
/// carries: displacements (ux uy uz rx ry rz), x along the rail, y level across it, z across both, upwards. A beam of
/// span L, simply supported at both ends, under a force F and a moment M at a point a from one support and b = L - a
/// from the other (S. P. Timoshenko, Strength of Materials I):
///   deflection  w     = (F a^2 b^2 + M a b (b - a)) / (3 E I L)
///   slope       dw/dx = (F a b (b - a) + M (L^2 - 3 a b)) / (3 E I L)
/// Off the rail w = uz and dw/dx = -ry, level w = uy and dw/dx = rz. Under a torque T, held at both ends, it twists by
/// T a b / (G J L). Rows of what does not give are zero. m, N, rad, Nm.
Eigen::Matrix<double, 6, 6> railCompliance(const RailBeam& beam, double position);
Eigen::Matrix<double, 6, 6> railStiffness(const RailBeam& beam, double position);

/// Whether the carriage stands between the supports, clear of them by a hundredth of the span.
bool carries(const RailBeam& beam, double position);

}  // namespace stiffscope::simulation
