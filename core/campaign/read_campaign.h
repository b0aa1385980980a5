#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

struct CampaignReading {
  Campaign campaign;
  std::vector<std::string> warnings;  ///< one line each: `FILE:LINE: COLUMN: 'VALUE': FINDING`
};

/// Whether the files' hashes are wanted: what shows none is quicker without.
enum class Hashes { taken, left };

/// Reads a campaign folder, or its campaign.xml, with every table it names (campaign format, version 1).
/// Converts to SI and radians; poses and nests are numbered in order of first appearance, the tables taken in
/// the format's order. Each file is read once, and hashed as it was read (else Campaign::inputs has no hashes). What the
/// format does not know (columns, elements, attributes) is ignored with a warning.
/// Throws InputError for anything the format does not allow, with file, line, column and value: missing or
/// repeated elements, columns and keys, numbers that are none or cannot be meant (angles beyond 720 deg,
/// coordinates beyond 200 m, displacements beyond 1 m, forces and moments beyond 1e6), unknown targets and
/// links, load states without a row in `states`, files outside the folder.
CampaignReading readCampaign(const std::filesystem::path& folder_or_xml, Hashes hashes = Hashes::taken);

}  // namespace stiffscope
