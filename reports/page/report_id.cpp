#include "reports/page/report_id.h"

#include <fmt/format.h>

#include "core/input/sha256.h"

namespace stiffscope {

std::string reportId(const ReportContent& content) {
  std::string all = content.compare_with_paper ? "paper\n" : "\n";
  // Lengths keep apart what would read the same run together.
  const auto add = [&all](const std::string& text) { all += fmt::format("{}:{}\n", text.size(), text); };
  for (const ReportCampaign& one : content.campaigns) {
    add(one.campaign.name);
    add(one.campaign.date);
    for (const InputFile& file : one.campaign.inputs) {
      add(file.name);
      add(file.sha256);
    }
  }
  for (const NamedText& setting : content.settings) {
    add(setting.name);
    add(setting.text);
  }
  if (!content.versions.empty()) add(content.versions.front().text);
  const std::string hex = sha256Hex(all);
  return fmt::format("{}-{}-{}", hex.substr(0, 4), hex.substr(4, 4), hex.substr(8, 4));
}

}  // namespace stiffscope
