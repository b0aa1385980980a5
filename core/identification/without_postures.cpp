#include "core/identification/without_postures.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/units.h"

namespace stiffscope {

namespace {

template <class Table>
void drop(Table& table, const std::vector<bool>& dropped) {
  if (!table) return;
  std::erase_if(table->rows, [&](const auto& row) { return dropped[static_cast<std::size_t>(row.pose)]; });
  table->rows.shrink_to_fit();  // most of a long day may go
}

}  // namespace

void dropPostures(const std::vector<bool>& dropped, Campaign& campaign) {
  drop(campaign.loading, dropped);
  drop(campaign.states, dropped);
  drop(campaign.displacements, dropped);
}

Campaign withoutPostures(const Campaign& campaign, const std::vector<OutlyingPosture>& postures) {
  std::vector<bool> dropped(campaign.pose_ids.size(), false);
  for (const OutlyingPosture& one : postures) dropped[static_cast<std::size_t>(one.posture)] = true;
  Campaign rest = campaign;
  dropPostures(dropped, rest);
  return rest;
}

void nameLeftOut(const Campaign& campaign, const std::vector<OutlyingPosture>& postures,
                 std::vector<std::string>& left_out) {
  for (const OutlyingPosture& one : postures) {
    const std::string start = fmt::format("pose {}:", campaign.pose_ids[static_cast<std::size_t>(one.posture)]);
    std::erase_if(left_out, [&](const std::string& text) { return text.starts_with(start); });
    left_out.push_back(fmt::format("{} disagrees with the other postures by {:.0f} µm per coordinate, {:.1f} times theirs",
                                   start, one.rms / kMicrometre, one.rms / one.others));
  }
}

}  // namespace stiffscope
