#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

struct CampaignReading {
  Campaign campaign;
  std::vector<std::string> warnings;  ///< one line each: unknown columns and the like
};

/// Reads a campaign folder, or its campaign.xml, with every table it names (campaign format, version 1).
/// Converts to SI and radians. Throws InputError for anything the format does not allow.
CampaignReading readCampaign(const std::filesystem::path& folder_or_xml);

}  // namespace stiffscope
