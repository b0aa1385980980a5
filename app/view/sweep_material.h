#pragma once

#include "app/view/view_material.h"
#include "core/campaign/campaign.h"
#include "core/frames/frames.h"

namespace stiffscope {

/// The circle sweeps, an axis each: the arm as it stood in the middle of the sweep, with the readings of all
/// sweeps as dots, those of this one in full colour. The arm is drawn rigid, without its own weight's sag. No
/// frames, and the reason in `lacking`, where the campaign has no circle sweeps or they do not place R0.
ViewMaterial sweepMaterial(const Campaign& campaign, const Frames& frames);

}  // namespace stiffscope
