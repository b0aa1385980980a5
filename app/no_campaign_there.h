#pragma once

#include <filesystem>
#include <string>

namespace stiffscope {

/// Throws std::runtime_error where `folder` holds a campaign.xml, for what is not to be written among a day's tables; ends
/// in `expectation`.
void requireNoCampaign(const std::filesystem::path& folder, const std::string& expectation);

}  // namespace stiffscope
