#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/fitted_arm.h"
#include "core/calibration/unloaded_day.h"

namespace stiffscope::calibration {

/// Three numbers with their standard uncertainties, m or rad; 0: held.
struct UncertainPoint {
  Eigen::Vector3d value = Eigen::Vector3d::Zero(), sd = Eigen::Vector3d::Zero();
};

/// Where the tracker stands in base_link: its place p follows the base's parameters by dp = r x (p - centre) + s.
UncertainPoint stationInBase(const UnloadedDay& day, const ArmFit& fit);

/// Rotation vector from the readings' axes to base_link's; sd: of a small turn about base_link's axes.
UncertainPoint turnOfStation(const ArmFit& fit);

/// Each reflector in the flange's frame, as the fitted arm has it at zero, the arm's own uncertainty not in it.
std::vector<UncertainPoint> targetsInFlange(const UnloadedDay& day, const ArmFit& fit);

}  // namespace stiffscope::calibration
