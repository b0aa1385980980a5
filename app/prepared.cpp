#include "app/prepared.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "app/output.h"

namespace stiffscope {

void addRawOption(CLI::App& command, bool& raw) {
  command.add_flag(
      "--raw", raw,
      "take the readings as they were read: leave out none that the audit rejects, take off no drift "
      "that the floor nests show");
}

PreparedCampaign openPrepared(const std::string& folder_or_xml, bool raw, Hashes hashes) {
  Campaign campaign = openCampaign(folder_or_xml, hashes);
  return raw ? leaveRaw(std::move(campaign)) : prepareCampaign(std::move(campaign));
}

}  // namespace stiffscope
