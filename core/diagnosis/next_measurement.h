#pragma once

#include <cstdint>
#include <optional>

#include "core/diagnosis/verdict.h"

namespace stiffscope::diagnosis {

/// The one more posture and load that would best tell the effects of a tie apart: of random postures within
/// the joint limits (above the floor), each pulled by the campaign's largest force along each axis of R0 at
/// the same point of the tool, that where the least of the tied effects' separations (see separation) grows
/// most. Read as the campaign reads. Empty where none helps.
std::optional<NextMeasurement> nextFor(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed,
                                       const Tie& tie, std::uint64_t seed);

}  // namespace stiffscope::diagnosis
