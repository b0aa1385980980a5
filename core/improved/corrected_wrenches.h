#pragma once

#include "core/improved/fitted_effects.h"

namespace stiffscope {

/// Corrects the load cell's declared point by load_point_error, and the readings in `states` by misalignment (a
/// finite rotation) and bias. Throws InputError where the point does not move with the flange.
void correctWrenches(const EffectFit& effects, const Eigen::VectorXd& parameters, Campaign& campaign);

}  // namespace stiffscope
