#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/estimate.h"
#include "metrology/remark.h"

namespace stiffscope::identification {

/// Puts stiffnesses that are known from elsewhere into the joints that the day cannot see: c = 1/k with u(c) =
/// u(k)/k^2, independent of the day's. Returns those put in; a joint that the day sees keeps its own value.
std::vector<campaign::KnownStiffness> completeByKnown(const std::vector<campaign::KnownStiffness>& known,
                                                      StiffnessEstimate& estimate);

/// A remark on each known stiffness that the day's own value contradicts: |c - c_known| > sqrt(U^2 + U_known^2), U the
/// distance from c to the end of its 95 % interval on the side of c_known, U_known = 1.96 u(c_known).
std::vector<Remark> contradictedKnown(const std::vector<campaign::KnownStiffness>& known,
                                      const StiffnessEstimate& estimate);

}  // namespace stiffscope::identification
