#pragma once

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/linear_system.h"
#include "core/preparation/station_course.h"

namespace stiffscope::diagnosis {

/// What a campaign has that effects need.
struct CampaignHas {
  std::size_t reflectors = 0;
  std::size_t load_steps = 0;  ///< with a force, beyond the return share
  bool return_to_zero = false;
  bool moments = false;  ///< some moment was measured
  bool times = false;
  bool weights = false;  ///< masses of the arm are known
  bool absolute = false, sweeps = false;
  bool nests = false;
};

CampaignHas whatIsThere(const GapInput& input, const GapData& data, const GapState& state,
                        const preparation::DriftModel& station);

/// Why an effect cannot be tested with this, in words that name what is missing; empty where it can.
std::string missingFor(effects::Effect effect, const CampaignHas& has);

}  // namespace stiffscope::diagnosis
