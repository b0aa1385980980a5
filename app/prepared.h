#pragma once

#include <string>

#include "core/calibration/unloaded_day.h"
#include "core/campaign/campaign.h"
#include "core/campaign/read_campaign.h"
#include "core/preparation/prepare.h"

namespace CLI {
class App;
}

namespace stiffscope::app {

/// Adds --raw to a command.
void addRawOption(CLI::App& command, bool& raw);

/// Throws InputError for a day without a load. `calibrate` is for it.
void requireLoad(const campaign::Campaign& campaign);

/// Throws InputError where commanded angles are wanted and no joint has them in every unloaded posture.
void requireCommanded(const campaign::Campaign& campaign, calibration::JointAngles angles);

/// A campaign as the commands compute from it: without rejected readings and referred to where the station
/// first stood, as the audit finds them; with `raw` as it was read. Warnings go to standard error.
preparation::PreparedCampaign openPrepared(const std::string& folder_or_xml, bool raw,
                                           campaign::Hashes hashes = campaign::Hashes::taken);

}  // namespace stiffscope::app
