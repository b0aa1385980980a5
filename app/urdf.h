#pragma once

#include <filesystem>
#include <string>

#include "core/campaign/campaign.h"

namespace stiffscope::app {

/// The URDF that a campaign was read with.
std::filesystem::path urdfOf(const campaign::Campaign& campaign);

/// Its bytes.
std::string urdfBytes(const campaign::Campaign& campaign);

/// Writes it with the origins of `arm` (calibration::calibratedUrdf), an arm in base_link. Throws std::runtime_error
/// where `file` is one that was read.
void writeCalibratedUrdf(const campaign::Campaign& campaign, const robot::Robot& arm, const std::string& file);

}  // namespace stiffscope::app
