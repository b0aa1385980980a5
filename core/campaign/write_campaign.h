#pragma once

#include <filesystem>

#include "core/campaign/campaign.h"

namespace stiffscope {

/// Writes campaign.xml and every table present into `folder` (made if absent), in the units of the campaign
/// format, with the same bytes for the same campaign. `urdf_file` is copied beside them as robot.urdf.
/// Throws std::filesystem::filesystem_error or std::runtime_error where the folder cannot be written.
void writeCampaign(const Campaign& campaign, const std::filesystem::path& urdf_file,
                   const std::filesystem::path& folder);

}  // namespace stiffscope
