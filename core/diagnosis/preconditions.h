#pragma once

#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/linear_system.h"
#include "core/preparation/station_course.h"

namespace stiffscope::diagnosis {

/// What the campaign has that effects need (effects::missingFor).
effects::CampaignContents whatIsThere(const SystemInput& input, const SystemState& state,
                                      const preparation::DriftModel& station);

}  // namespace stiffscope::diagnosis
