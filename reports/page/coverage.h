#pragma once

#include "core/identification/stiffness_estimate.h"

namespace stiffscope::page {

/// From standard to expanded uncertainty, U = k u (GUM, annex G): Student's t for 95 % at the effective degrees of
/// freedom of a joint's compliance. NaN where none is left.
struct Coverage {
  double factor = 0.0;
  double degrees_of_freedom = 0.0;
};
Coverage coverageOf(const StiffnessEstimate& estimate, int joint);

}  // namespace stiffscope::page
