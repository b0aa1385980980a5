#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/finding.h"

namespace stiffscope::preparation {

/// Readings that repeat another's coordinates to the last digit: the other copied, or the beam still on the other
/// reflector. Two readings of one reflector at one place come out alike by chance where the file has few digits:
/// with a last digit of r and a noise of s per coordinate, each pair does with the product of r / (2 sqrt(pi) s). As
/// many such pairs as chance gives a table (Poisson, at a thousandth) are none.
std::vector<RejectedReading> duplicateReadings(const campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
