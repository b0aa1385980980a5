#pragma once

#include <Eigen/Core>

#include "core/campaign/campaign.h"
#include "core/simulation/random.h"

namespace stiffscope::simulation {

/// One draw of a tracker reading's error (m, tracker frame) at a true point of that frame. With d the
/// distance from the station: normal along the line of sight with sigma factor (range_fixed + range_per_m d),
/// and across it in two directions at right angles with sigma factor (angle_fixed + angle_per_m d) each, all
/// independent. `factor` is true sigma over declared sigma. Takes three numbers from the stream: along,
/// across, across.
Eigen::Vector3d trackerError(const Tracker& tracker, double factor, const Eigen::Vector3d& point,
                             RandomStream& random);

/// Adds an error of its own to every point of the campaign's tables (tracker frame): streams "tracker
/// sweeps", "tracker wrist", "tracker loading" and "tracker nests" of `noise_seed`.
void addTrackerNoise(double factor, std::uint64_t noise_seed, Campaign& campaign);

}  // namespace stiffscope::simulation
