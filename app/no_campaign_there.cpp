#include "app/no_campaign_there.h"

#include <stdexcept>
#include <system_error>

namespace stiffscope {

void requireNoCampaign(const std::filesystem::path& folder, const std::string& expectation) {
  std::error_code none;
  if (!std::filesystem::exists(folder / "campaign.xml", none)) return;
  throw std::runtime_error(folder.string() + ": not written: it holds a campaign; " + expectation);
}

}  // namespace stiffscope
