#pragma once

#include <string>

#include "core/campaign/campaign.h"

namespace stiffscope {

/// campaign.xml of a campaign, in the units of the format: the URDF is named robot.urdf, a table after its
/// element (circle_sweeps.csv). Numbers have up to 12 significant digits.
std::string writtenCampaignXml(const Campaign& campaign);

}  // namespace stiffscope
