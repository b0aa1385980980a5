#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::campaign {

/// What no table shows alone, on a campaign as it was read.
/// Throws InputError for a load state without a row in `states` (where that table is present), and for
/// a displacement of a target whose place on the flange is not given; of a robot on a rail for tables that do not say
/// where the carriage stood, and for readings from several of its positions without a `rail_sweep`; of one without a
/// rail for a `rail_sweep` and for positions that differ. Warns of poses of `loading` without
/// a step 0, of joint angles more than 5 degrees outside the URDF's limits (one warning a joint), of tables
/// whose angles look like radians, and of states without a load cell.
/// Of balancers, see checkBalancers. Of several stations: throws InputError where there is no tracker, and for a
/// reflector that one posture has from two of them.
void checkCampaign(const Campaign& campaign, std::vector<std::string>& warnings);

/// Throws InputError where a station is named that means nothing: in `displacements`, or in a table whose points are in
/// base_link. `names`: by Row::station as the tables were read; the first is that of rows that name none.
void requireStationsWherePointsAre(const Campaign& campaign, const std::vector<std::string>& names);

}  // namespace stiffscope::campaign
