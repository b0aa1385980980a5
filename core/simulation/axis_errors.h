#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The errors of the six axes: as listed, else drawn from stream "geometry" of the seed. A listed axis leaves
/// the others' draws as they were.
std::array<AxisError, 6> drawAxisErrors(const SimulationSpec& spec);

/// E_i: where joint frame i and all that it carries truly stands at zero, from where the nominal robot has it
/// (base_link): first turned by the tilt about the axis's point - about the wrist centre for axes 4-6 if
/// these meet within 1 um - then moved by the offset. So the errors add up along the chain, the flange stays
/// true to axis 6, and wrist axes miss each other only by the offsets of 5 and 6.
Eigen::Isometry3d frameError(const Robot& nominal, int joint, const AxisError& error);

}  // namespace stiffscope::simulation
