#include "core/frames/geometry_calibration.h"

namespace stiffscope::frames {

std::vector<UnloadedPosition> unloadedPositions(const campaign::Campaign& campaign) {
  std::vector<UnloadedPosition> positions;
  if (!campaign.loading || !campaign.states) return positions;
  const std::size_t targets = campaign.targets.size();
  std::vector<UnloadedPosition> sums(campaign.pose_ids.size() * targets);
  for (const campaign::LoadingReading& reading : campaign.loading->rows) {
    if (reading.step != 0) continue;
    UnloadedPosition& sum =
        sums[static_cast<std::size_t>(reading.pose) * targets + static_cast<std::size_t>(reading.target)];
    sum.pose = reading.pose;
    sum.target = reading.target;
    sum.point += reading.point;
    sum.station = reading.station;
    sum.from = reading.from;
    ++sum.readings;
  }
  std::vector<const campaign::State*> states(campaign.pose_ids.size(), nullptr);
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0) states[static_cast<std::size_t>(state.pose)] = &state;
  }
  for (UnloadedPosition& sum : sums) {
    if (sum.readings == 0 || states[static_cast<std::size_t>(sum.pose)] == nullptr) continue;
    sum.point /= sum.readings;
    sum.q = states[static_cast<std::size_t>(sum.pose)]->q;
    positions.push_back(sum);
  }
  return positions;
}

}  // namespace stiffscope::frames
