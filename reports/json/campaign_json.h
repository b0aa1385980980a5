#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/prepare.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// Which campaign a result is of: name, date, robot, double encoder, and the files it was read from with their hashes.
Json campaignJson(const campaign::Campaign& campaign);

/// `active`, `inactive` or `unspecified`, as the campaign format spells it.
const char* nameOf(campaign::DoubleEncoder state);
Json jointNumbers(const std::vector<int>& joints);  ///< from 1

/// What was done to the readings: raw, rejected readings with file, line and reason, and the drift of
/// the station that they were corrected for, or why not.
Json preparationJson(const preparation::Preparation& preparation);

/// A result with `preparation` added: what was done to the readings that it comes from.
Json withPreparation(Json result, const preparation::Preparation& preparation);

/// The list that the audit and the preparation share.
Json rejectedJson(const std::vector<preparation::RejectedReading>& rejected);

}  // namespace stiffscope::reports
