#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/equations.h"
#include "core/identification/estimate.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

/// What the tracker's declared noise alone puts into displacements: the expected norm of the error, summed as
/// the compensated fraction sums, so that its ratio to the displacement is the share no model can take away.
struct NoiseShare {
  std::optional<double> at_wrist;  ///< sum of E|error| / sum |displacement| at P_wrist; empty where not measured
  double at_targets = 0.0;         ///< the same at the reflectors
  double per_coordinate = 0.0;     ///< rms noise of a reflector's displacement, per coordinate, m
};

/// Covariance of one reflector's displacement, by the reading counts of both states; R0 axes, m^2.
Eigen::Matrix3d displacementCovariance(const campaign::Tracker& tracker, const Eigen::Isometry3d& r0_from_loading,
                                       const TargetMove& move);

/// Empty without a tracker or without absolute points. P_wrist's error is that of the reflectors through
/// (13)-(20), by central differences; E|error| of a 3-D normal error is taken as 0.921 sqrt(trace), exact for
/// an isotropic one.
std::optional<NoiseShare> noiseShare(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                     const std::vector<LoadCase>& cases, const std::vector<WristMove>& wrist,
                                     const std::vector<double>& radii, const Eigen::Vector3d& centre_at_zero);

/// A^T W A of each case's reflector equations, W the covariance of its rows by the tracker's declared noise (R0, m^2).
/// Reflectors are independent of each other. Empty where positions are not absolute.
std::vector<JointMatrix> reflectorNoise(const campaign::Tracker& tracker, const LoadedArm& arm,
                                        const std::vector<CaseEquations>& equations);

/// The scatter covariance of one-stage least squares is right on average, and its degrees of freedom are, for errors
/// that are alike in all rows (CR2). The tracker's are not: along its beam they are a fifth of those across, and they
/// grow with the distance. This makes both right for errors of covariance W, to a common factor, which stays that of
/// the scatter (Pustejovsky and Tipton 2018, with W as working model): the influences on joint j are multiplied by the
/// root of [N^-1 A^T W A N^-1]_jj over the expectation of their sum of squares. `normal` and `noise`: A^T A and A^T W
/// A, one a posture.
void correctForNoise(const std::vector<NormalEquations>& normal, const std::vector<JointMatrix>& noise,
                     StiffnessEstimate& estimate);

}  // namespace stiffscope::identification
