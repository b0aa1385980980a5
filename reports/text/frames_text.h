#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/frames/frames.h"

namespace stiffscope::reports {

/// The result of `frames` for a terminal: plain text, no line over 100 columns but for names from the campaign.
std::string framesText(const campaign::Campaign& campaign, const frames::Frames& frames);

}  // namespace stiffscope::reports
