#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/fleet/campaign_result.h"
#include "core/fleet/fleet.h"
#include "core/numerics/shard.h"

namespace stiffscope::app {

struct FleetRequest {
  std::vector<std::string> folders;  ///< campaigns are found below them
  std::filesystem::path out;
  std::size_t jobs = 0;       ///< processes at a time; 0: the cores
  bool reports = false;       ///< each campaign its own report
  bool springs_only = false;  ///< see fleetDay
};

/// A campaign that was found, and what its campaign.xml says before anything is computed.
struct FoundCampaign {
  fleet::FleetCampaign campaign;
  std::string key;              ///< 16 hex digits: of its files, the options and the version of the program
  bool maybe_unloaded = false;  ///< no load cell: it may have to be held against the day before
};

/// The fleet's campaigns in its order: folders with a campaign.xml below those given, each once. Throws io::InputError
/// where there is none.
std::vector<FoundCampaign> findCampaigns(const FleetRequest& request);

/// Does what is not done yet of the campaigns, and of the pairs of days without a load, that are `shard`'s: each by a
/// process of its own, whose result is a file of its own in out/campaigns, out/pairs, out/reports that appears whole. A
/// process that ends otherwise leaves its message there for the row, and is begun again by the next run.
void doFleetWork(const FleetRequest& request, const std::vector<FoundCampaign>& found, const numerics::Shard& shard);

/// The fleet from these files. Pairs that only the results show to follow each other (a campaign between them has none)
/// are compared here. Throws std::runtime_error, saying how many, where campaigns have neither result nor message.
fleet::Fleet fleetFrom(const FleetRequest& request, const std::vector<FoundCampaign>& found);

/// What a process of it does: the result of one campaign, or of two, into `file`.
void writeOneResult(const std::vector<std::string>& folders, bool springs_only, const std::filesystem::path& file);

/// What a fleet keeps of a campaign: audited; under loads identified (`springs_only`: without further effects in the
/// model) and diagnosed; without a load calibrated and diagnosed. Throws what reading and computing throw.
fleet::CampaignResult fleetDay(const std::string& folder, bool springs_only);

/// Two days without a load of one machine.
fleet::PairResult fleetPair(const std::string& before, const std::string& after);

}  // namespace stiffscope::app
