// stiffness_of CAMPAIGN: each joint's stiffness by Partial Pose, joint springs alone.

#include <cstdio>
#include <exception>

#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "stiffness_of CAMPAIGN\n");
    return 2;
  }
  try {
    using namespace stiffscope;
    const auto prepared = preparation::prepareCampaign(campaign::readCampaign(words[1]).campaign);
    const auto found = identification::identify(prepared.campaign, {});
    const auto& estimate = found.methods[static_cast<std::size_t>(identification::Method::partial_pose)].estimate;
    for (int joint = 0; joint < 6; ++joint) {
      if (estimate.identifiable[static_cast<std::size_t>(joint)]) {
        std::printf("k%d %.6g Nm/rad\n", joint + 1, 1.0 / estimate.compliance[joint]);
      } else {
        std::printf("k%d not identifiable\n", joint + 1);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffness_of: %s\n", error.what());
    return 2;
  }
}
