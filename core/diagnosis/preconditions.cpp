#include "core/diagnosis/preconditions.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/diagnosis/system_rows.h"

namespace stiffscope::diagnosis {

effects::CampaignContents whatIsThere(const SystemInput& input, const SystemState& state,
                                      const preparation::DriftModel& station) {
  effects::CampaignContents has;
  has.absolute = input.absolute;
  has.sweeps = input.sweeps;
  has.nests = station.motion.tested;
  has.weights = state.geometry.weight.links_known;
  std::set<int> steps;
  for (const SystemRows& posture : loadingRows(input.campaign, state.geometry, state.at, state.corrections)) {
    has.reflectors = std::max(has.reflectors, posture.states.front().points.size());
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      const effects::ArmState& one = posture.states[s];
      if (one.loaded) steps.insert(one.step);
      if (!one.loaded) has.return_to_zero = true;
      if (std::isfinite(one.time_s)) has.times = true;
    }
  }
  has.load_steps = steps.size();
  for (const campaign::State& row : input.campaign.states->rows) has.moments |= !row.wrench_in_cell.tail<3>().isZero();
  return has;
}

}  // namespace stiffscope::diagnosis
