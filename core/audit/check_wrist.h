#pragma once

#include <cstddef>

#include "core/audit/audit_input.h"

namespace stiffscope::audit {

/// What the wrist sweep leaves of P_wrist's spheres once the swept axes 4-6, which do not quite meet, have
/// their share.
struct WristResiduals {
  double chi2 = 0.0;      ///< by the tracker's noise along each radius
  int dof = 0;            ///< readings less centre and radii
  double rms = 0.0;       ///< m, over `dof`
  std::size_t worst = 0;  ///< line of the reading that is farthest off, in parts of its noise
};

/// Radial distances of the readings less those that forward kinematics in the swept geometry gives, by one
/// weighted linear least squares in the centre (free), a radius per reflector (free) and the parameters of
/// axes 4-6, four each, held by the covariance of their own sweeps. That prior makes the sum of squares
/// chi-square with `dof` degrees of freedom: an axis's error is one number for the whole sweep, and added to
/// each reading's variance instead it would be averaged away over a thousand readings that share it. The
/// wrist is measured, axes 4-6 are, and the noise is declared.
WristResiduals wristResiduals(const AuditInput& input);

}  // namespace stiffscope::audit
