#include "reports/one_machine.h"

#include <fmt/format.h>

#include "core/comparison/matched_postures.h"

namespace stiffscope {

std::vector<std::string> doubtsOfTheMachine(const std::vector<ReportCampaign>& campaigns) {
  std::vector<std::string> sentences;
  for (std::size_t i = 1; i < campaigns.size(); ++i) {
    const Campaign &first = campaigns.front().campaign, &other = campaigns[i].campaign;
    std::vector<std::string> doubts{differenceOfMachines(first.robot, other.robot)};
    if (doubts.front().empty()) doubts = doubtsOfOneMachine(first.robot, other.robot);
    for (const std::string& doubt : doubts)
      sentences.push_back(fmt::format("{} and {}: {}", first.name, other.name, doubt));
  }
  return sentences;
}

}  // namespace stiffscope
