#pragma once

#include "core/identification/identify.h"

namespace stiffscope::page {

/// From standard to expanded uncertainty, U = k u (GUM, annex G): Student's t for 95 % at the degrees of
/// freedom that the scatter between postures leaves, postures less those that the unknowns take up (a posture
/// gives three coordinates). NaN where none is left.
struct Coverage {
  double factor = 0.0;
  int degrees_of_freedom = 0;
};
Coverage coverageOf(const Identification& identification, const StiffnessEstimate& estimate);

}  // namespace stiffscope::page
