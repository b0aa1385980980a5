#include "core/diagnosis/preconditions.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/diagnosis/system_rows.h"

namespace stiffscope::diagnosis {

namespace {

/// Of the postures that are loaded, as many as stand apart from each other.
int carriagePositions(const campaign::States& states) {
  constexpr double kApart = 0.01;  // m: less hardly changes what a rail gives
  std::vector<double> positions;
  for (const campaign::State& row : states.rows) {
    if (row.step > 0 && std::isfinite(row.carriage)) positions.push_back(row.carriage);
  }
  std::sort(positions.begin(), positions.end());
  int apart = 0;
  double last = 0.0;
  for (const double position : positions) {
    if (apart > 0 && position - last < kApart) continue;
    last = position;
    ++apart;
  }
  return apart;
}

}  // namespace

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
  if (input.campaign.robot.rail) has.carriage_positions = carriagePositions(*input.campaign.states);
  return has;
}

}  // namespace stiffscope::diagnosis
