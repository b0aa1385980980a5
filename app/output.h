#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// Exit statuses of the command line.
inline constexpr int kDone = 0;
inline constexpr int kNotUsable = 1;  ///< done, but the result does not serve its purpose
inline constexpr int kBadInput = 2;

/// Reads a campaign; its warnings go to standard error.
Campaign openCampaign(const std::string& folder_or_xml);

void printWarnings(const std::vector<std::string>& warnings);

/// The result: as JSON to `json_file` (`-` is standard output) if one is named, else `text` to standard output. With a
/// file named, `text` goes to standard output too.
void deliver(const Json& json, const std::string& text, const std::string& json_file);

}  // namespace stiffscope
