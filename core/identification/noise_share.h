#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/wrist_move.h"

namespace stiffscope {

/// What the tracker's declared noise alone puts into displacements: the expected norm of the error, summed as
/// the compensated fraction sums, so that its ratio to the displacement is the share no model can take away.
struct NoiseShare {
  std::optional<double> at_wrist;  ///< sum of E|error| / sum |displacement| at P_wrist; empty where not measured
  double at_targets = 0.0;         ///< the same at the reflectors
  double per_coordinate = 0.0;     ///< rms noise of a reflector's displacement, per coordinate, m
};

/// Covariance of one reflector's displacement, by the reading counts of both states; R0 axes, m^2.
Eigen::Matrix3d displacementCovariance(const Tracker& tracker, const Eigen::Isometry3d& r0_from_loading,
                                       const TargetMove& move);

/// Empty without a tracker or without absolute points. P_wrist's error is that of the reflectors through
/// (13)-(20), by central differences; E|error| of a 3-D normal error is taken as 0.921 sqrt(trace), exact for
/// an isotropic one.
std::optional<NoiseShare> noiseShare(const Campaign& campaign, const LoadingGeometry& geometry,
                                     const std::vector<LoadCase>& cases, const std::vector<WristMove>& wrist,
                                     const std::vector<double>& radii, const Eigen::Vector3d& centre_at_zero);

}  // namespace stiffscope
