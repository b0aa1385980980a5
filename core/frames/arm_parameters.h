#pragma once

#include "core/frames/arm_geometry.h"
#include "core/frames/placed_arm.h"

namespace stiffscope::frames {

/// `axes` with directions across and covariances of their sweeps, each at the sweep's own point of the axis, for which
/// its covariance is. Only meant for axes that were measured.
AxesAtStart sweptAxes(const Frames& frames, const robot::ArmAxes& axes);

/// The geometry moved by all of its parameters, `steps` as long as ArmParameters::count of its reflectors. The flange,
/// and what is fixed to it, follows the last two axes (see ArmInR0).
LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps, const Eigen::Vector3d& centre);

}  // namespace stiffscope::frames
