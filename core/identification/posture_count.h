#pragma once

#include "core/identification/identification.h"

namespace stiffscope {

/// The postures that were used: with all load steps together a posture has several load cases.
std::size_t postureCount(const Identification& result);

}  // namespace stiffscope
