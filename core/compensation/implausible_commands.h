#pragma once

#include <string>
#include <vector>

#include "core/compensation/compensate.h"

namespace stiffscope {

/// A sentence for each posture whose commands turn a joint by more than 2 deg against its angle: ten times
/// what a heavy load does to a weak joint, so that forces, moments or angles are rather in another unit.
std::vector<std::string> implausibleCommands(const std::vector<CompensatedPosture>& postures);

}  // namespace stiffscope
