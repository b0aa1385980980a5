#pragma once

#include <optional>

#include "core/identification/loading_geometry.h"
#include "core/statics/wrench.h"

namespace stiffscope {

/// The load cell's reading as a wrench in R0 (paper (30)): directed as the flange stands loaded, acting where
/// the cell stands unloaded. Flange poses (base_from_flange) are those measured by the reflectors where there
/// are any, else the model's at `posture`. `reading`: force (N) then moment (Nm) in the load cell's axes.
Wrench cellWrench(const LoadCell& cell, const LoadingGeometry& geometry, const ArmPosture& posture,
                  const std::optional<Eigen::Isometry3d>& flange_unloaded,
                  const std::optional<Eigen::Isometry3d>& flange_loaded, const Vector6d& reading);

/// The body whose turn directs the load cell's axes: 0 where they stand still, 6 where they turn with the
/// flange.
int bodyOfCellAxes(const LoadCell& cell, const LoadingGeometry& geometry);

}  // namespace stiffscope
