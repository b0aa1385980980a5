#pragma once

#include <Eigen/Core>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Tip stiffness K (6x6, order ux uy uz rx ry rz, z along the beam, tip axes) of a clamped uniform beam of
/// length L (m), the inverse, plane by plane, of
///   | u |   | L^3/(3EI) + L/(kGA)   L^2/(2EI) | | F |
///   | r | = | L^2/(2EI)             L/EI      | | M |
/// (Timoshenko; without shear Euler-Bernoulli), with EA/L along and GJ/L about the beam. Rows of what the
/// beam does not state are zero. S. P. Timoshenko, Strength of Materials I. Linear in the tip's displacement:
/// right for tip rotations small against 1; what lies beyond is still turned by the finite rotation.
Eigen::Matrix<double, 6, 6> beamTipStiffness(const LinkBeam& beam, double length);

}  // namespace stiffscope::simulation
