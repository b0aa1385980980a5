#pragma once

#include <optional>

#include "core/identification/normal_equations.h"

namespace stiffscope {

/// Natural logarithm of the determinant of an information matrix over the joints of the mask; minus infinity
/// where it is singular.
double logDeterminant(const Matrix6d& information, const JointMask& unknown);

/// Standard deviations of the compliances, rad/Nm: roots of the inverse's diagonal; infinite where it is
/// singular, not a number for a joint that is no unknown.
Vector6d standardDeviations(const Matrix6d& information, const JointMask& unknown);

/// What a design is judged by; larger is better. Without `reference`: logDeterminant (D-optimal). With it,
/// standard deviations s_j of the compliances that would be welcome: minus the logarithm of the 8-norm of
/// sd_j / s_j, nearly their largest, so that no joint pays for another (D-optimal designs trade a joint that
/// is hard to see for easy ones).
double designValue(const Matrix6d& information, const JointMask& unknown,
                   const std::optional<Vector6d>& reference);

/// The same from what a designer of many has at hand: logarithm of the determinant by Cholesky, and minus the
/// logarithm of the 8-norm of sd_j / s_j over the joints of the mask.
double choleskyLogDeterminant(const Matrix6d& matrix);
double balanceOf(const Vector6d& sd, const Vector6d& reference, const JointMask& unknown);

}  // namespace stiffscope
