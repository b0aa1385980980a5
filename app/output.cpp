#include "app/output.h"

#include <cstdio>

#include "core/campaign/read_campaign.h"
#include "core/input/write_file.h"

namespace stiffscope {

Campaign openCampaign(const std::string& folder_or_xml) {
  CampaignReading reading = readCampaign(folder_or_xml);
  printWarnings(reading.warnings);
  return std::move(reading.campaign);
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "stiffscope: warning: %s\n", warning.c_str());
}

void deliver(const Json& json, const std::string& text, const std::string& json_file) {
  if (json_file == "-") {
    const std::string dumped = json.dump(1) + '\n';
    std::fwrite(dumped.data(), 1, dumped.size(), stdout);
    return;
  }
  if (!json_file.empty()) writeFileWhole(json_file, json.dump(1) + '\n');
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace stiffscope
