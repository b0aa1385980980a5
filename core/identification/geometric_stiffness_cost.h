#pragma once

#include <string>
#include <vector>

#include "core/identification/identification.h"

namespace stiffscope::identification {

/// What neglecting K_c of (4) costs in one load case: how far the modelled displacement moves when K_c is left out, at
/// the same stiffnesses.
struct GeometricStiffnessCost {
  double at_targets = 0.0;  ///< mean over the reflectors of |difference|, m
  double share = 0.0;       ///< of the modelled displacement's mean norm
};

/// One a load case of `result`, at its axes (of the geometry in which it stands) by one method's compliances. Empty
/// where the method is unavailable.
std::vector<GeometricStiffnessCost> geometricStiffnessCosts(const Identification& result, Method method);

}  // namespace stiffscope::identification
