#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/outlying_postures.h"

namespace stiffscope {

/// Takes away the load states and readings of the postures marked, by pose; their ids keep their places.
void dropPostures(const std::vector<bool>& dropped, Campaign& campaign);

/// The campaign without the load states and readings of these postures; their ids keep their places.
Campaign withoutPostures(const Campaign& campaign, const std::vector<OutlyingPosture>& postures);

/// Replaces what `left_out` says of these postures by why they are left out.
void nameLeftOut(const Campaign& campaign, const std::vector<OutlyingPosture>& postures,
                 std::vector<std::string>& left_out);

}  // namespace stiffscope
