#include "core/diagnosis/evenly_spread.h"

#include <algorithm>

namespace stiffscope {

namespace {

constexpr int kNotKept = -1;

/// The rows of the postures that are kept; `now` is the new index of each posture.
template <class Row>
std::optional<Table<Row>> ofPostures(const std::optional<Table<Row>>& table, const std::vector<int>& now) {
  if (!table) return std::nullopt;
  const auto posture = [&](const Row& row) { return now[static_cast<std::size_t>(row.pose)]; };
  Table<Row> kept{table->file, table->frame, {}};
  kept.rows.reserve(static_cast<std::size_t>(std::count_if(
      table->rows.begin(), table->rows.end(), [&](const Row& row) { return posture(row) != kNotKept; })));
  for (const Row& row : table->rows) {
    if (posture(row) == kNotKept) continue;
    kept.rows.push_back(row);
    kept.rows.back().pose = posture(row);
  }
  return kept;
}

}  // namespace

std::vector<int> evenlySpreadPostures(std::size_t postures, std::size_t most) {
  std::vector<int> spread(std::min(postures, most));
  for (std::size_t k = 0; k < spread.size(); ++k) spread[k] = static_cast<int>(k * postures / spread.size());
  return spread;
}

Campaign evenlySpread(const Campaign& campaign, std::size_t most) {
  // All of a Campaign by name: one more member does not compile until it is copied here.
  const auto& [folder, name, date, texts, robot, base_link, flange_link, double_encoder, gravity, tracker, targets,
               load_cell, tool, circle_sweeps, wrist_sweep, loading, states, displacements, nests, pose_ids, nest_ids,
               inputs] = campaign;
  std::vector<int> now(pose_ids.size(), kNotKept);
  std::vector<std::string> kept_ids;
  for (const int posture : evenlySpreadPostures(pose_ids.size(), most)) {
    now[static_cast<std::size_t>(posture)] = static_cast<int>(kept_ids.size());
    kept_ids.push_back(pose_ids[static_cast<std::size_t>(posture)]);
  }
  return {folder,        name,        date,           texts,       robot,
          base_link,     flange_link, double_encoder, gravity,     tracker,
          targets,       load_cell,   tool,           circle_sweeps, wrist_sweep,
          ofPostures(loading, now), ofPostures(states, now), ofPostures(displacements, now), nests, kept_ids,
          nest_ids,      inputs};
}

}  // namespace stiffscope
