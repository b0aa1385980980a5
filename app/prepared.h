#pragma once

#include <string>

#include "core/audit/prepare.h"
#include "core/campaign/read_campaign.h"

namespace CLI {
class App;
}

namespace stiffscope {

/// Adds --raw to a command.
void addRawOption(CLI::App& command, bool& raw);

/// A campaign as the commands compute from it: without rejected readings and referred to where the station
/// first stood, as the audit finds them; with `raw` as it was read. Warnings go to standard error.
PreparedCampaign openPrepared(const std::string& folder_or_xml, bool raw, Hashes hashes = Hashes::taken);

}  // namespace stiffscope
