#include "reports/page/coverage.h"

#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"

namespace stiffscope::page {

Coverage coverageOf(const Identification& identification, const StiffnessEstimate& estimate) {
  constexpr double kOutside = 0.05;
  const auto unknowns =
      static_cast<int>(std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true));
  const int left = static_cast<int>(identification.cases.size()) - (unknowns + 2) / 3;
  if (left < 1) return {std::nan(""), 0};
  return {studentLimit(kOutside, left), left};
}

}  // namespace stiffscope::page
