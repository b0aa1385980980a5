#include "reports/page/coverage.h"

#include <cmath>

#include "core/identification/coverage_factor.h"
#include "core/identification/stiffness_interval.h"

namespace stiffscope::page {

Coverage coverageOf(const StiffnessEstimate& estimate, int joint) {
  const double factor = coverageFactor(estimate, joint, kStatedCoverage);
  return {factor, std::isfinite(factor) ? estimate.dof(joint) : 0.0};
}

}  // namespace stiffscope::page
