#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/frames/frames.h"

namespace stiffscope {

/// The result of `frames` for a terminal: plain text, no line over 100 columns but for names from the campaign.
std::string framesText(const Campaign& campaign, const Frames& frames);

}  // namespace stiffscope
