#pragma once

#include "core/campaign/campaign.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// A^T W A of each case's reflector equations, W the covariance of its rows by the tracker's declared noise (R0, m^2).
/// Reflectors are independent of each other. Empty where positions are not absolute.
std::vector<Matrix6d> reflectorNoise(const Tracker& tracker, const LoadedArm& arm, const std::vector<CaseEquations>& equations);

/// The scatter covariance of one-stage least squares is right on average, and its degrees of freedom are, for errors that
/// are alike in all rows (CR2). The tracker's are not: along its beam they are a fifth of those across, and they grow with
/// the distance. This makes both right for errors of covariance W, to a common factor, which stays that of the scatter
/// (Pustejovsky and Tipton 2018, with W as working model): the influences on joint j are multiplied by the root of
/// [N^-1 A^T W A N^-1]_jj over the expectation of their sum of squares. `normal` and `noise`: A^T A and A^T W A, one a
/// posture.
void correctForNoise(const std::vector<NormalEquations>& normal, const std::vector<Matrix6d>& noise,
                     StiffnessEstimate& estimate);

}  // namespace stiffscope
