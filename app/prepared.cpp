#include "app/prepared.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>
#include <vector>

#include "app/computations.h"
#include "app/output.h"
#include "core/campaign/state_points.h"
#include "core/io/input_error.h"

namespace stiffscope::app {

void addRawOption(CLI::App& command, bool& raw) {
  command.add_flag("--raw", raw,
                   "take the readings as they were read: leave out none that the audit rejects, take off no drift "
                   "that the floor nests show");
}

void requireLoad(const campaign::Campaign& campaign) {
  if (!campaign::isUnloadedDay(campaign)) return;
  throw io::InputError({(campaign.folder / "campaign.xml").string(), 0, ""}, "",
                       "no load: stiffness and its gap need one; `stiffscope calibrate` fits unloaded postures");
}

void requireCommanded(const campaign::Campaign& campaign, calibration::JointAngles angles) {
  if (angles == calibration::JointAngles::reported) return;
  const PerJoint<bool> given = calibration::commandedJoints(campaign);
  if (std::any_of(given.begin(), given.end(), [](bool one) { return one; })) return;
  throw io::InputError({"--angles"}, "commanded",
                       fmt::format("no joint has a commanded angle (c1_deg to c{}_deg of `states`) in every unloaded "
                                   "posture",
                                   campaign.robot.joints()));
}

preparation::PreparedCampaign openPrepared(const std::string& folder_or_xml, bool raw, campaign::Hashes hashes) {
  campaign::Campaign campaign = openCampaign(folder_or_xml, hashes);
  return raw ? preparation::leaveRaw(std::move(campaign)) : preparation::prepareCampaign(std::move(campaign));
}

CampaignSource sourceOf(const std::string& folder_or_xml, bool raw, campaign::Hashes hashes) {
  return {folder_or_xml, [=] {
            return std::make_shared<const preparation::PreparedCampaign>(openPrepared(folder_or_xml, raw, hashes));
          }};
}

}  // namespace stiffscope::app
