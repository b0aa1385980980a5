#pragma once

#include "core/identification/identification.h"

namespace stiffscope::identification {

/// The L of the residual variances, m: feasible generalised least squares of Complete Pose. Displacements weigh by the
/// inverse variance of what they leave, rotations by theirs, so that L = s_d / s_r, s^2 the mean square of a block's
/// residuals at the compliances of that L; iterated from `start` to a fixed point. Both blocks have three rows a pose,
/// so the unknowns' degrees of freedom leave the ratio as it is. Empty where it does not settle between the shortest
/// and the longest length, or a block leaves nothing.
std::optional<double> residualVarianceLength(const std::vector<CaseEquations>& pose_rows,
                                             const robot::JointMask& unknown, double start);

/// Lengths at which Complete Pose is shown, from the curve of CharacteristicLength.
std::vector<LengthSensitivity> shownLengths(const CharacteristicLength& chosen);

/// How many subsets judge each of that many lengths: 500, fewer of very many postures, where the subsets hardly differ.
SubsetOptions subsetsOfALength(const SubsetOptions& asked, std::size_t postures, std::size_t lengths);

/// Complete Pose solved and judged at each length of `length_sensitivity`, and at the L of the residual variances
/// (`residual_length`), from the rows of its result. The rows stay those settled at its own L: what K_c and the middle
/// postures change with L is left out, a ten-thousandth of a share. `cases`: those that were solved.
void studyLengths(const std::vector<LoadCase>& cases, const IdentifyOptions& options, Identification& result);

}  // namespace stiffscope::identification
