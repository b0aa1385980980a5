#include "core/preparation/subsample.h"

#include <algorithm>
#include <map>
#include <utility>

namespace stiffscope::preparation {

namespace {

constexpr int kNotKept = -1;

/// The rows of the postures that are kept; `now` is the new index of each posture.
template <class Row>
std::optional<campaign::Table<Row>> rowsOf(const std::optional<campaign::Table<Row>>& table,
                                           const std::vector<int>& now) {
  if (!table) return std::nullopt;
  const auto posture = [&](const Row& row) { return now[static_cast<std::size_t>(row.pose)]; };
  campaign::Table<Row> kept{table->file, table->frame, {}};
  kept.rows.reserve(static_cast<std::size_t>(
      std::count_if(table->rows.begin(), table->rows.end(), [&](const Row& row) { return posture(row) != kNotKept; })));
  for (const Row& row : table->rows) {
    if (posture(row) == kNotKept) continue;
    kept.rows.push_back(row);
    kept.rows.back().pose = posture(row);
  }
  return kept;
}

/// As many readings of every kind, spread evenly over it: `kind(row)` is the reflector, with the axis of a circle
/// sweep.
template <class Row, class Kind>
std::optional<campaign::Table<Row>> ofReadings(const std::optional<campaign::Table<Row>>& table, std::size_t most,
                                               const Kind& kind) {
  if (!table || table->rows.size() <= most) return table;
  std::map<int, std::vector<std::size_t>> kinds;
  for (std::size_t i = 0; i < table->rows.size(); ++i) kinds[kind(table->rows[i])].push_back(i);
  const std::size_t of_each = std::max<std::size_t>(1, most / kinds.size());
  std::vector<std::size_t> taken;
  for (const auto& [name, rows] : kinds) {
    for (const std::size_t k : evenlySpreadIndices(rows.size(), of_each)) taken.push_back(rows[k]);
  }
  std::sort(taken.begin(), taken.end());  // the table's order is that of time
  campaign::Table<Row> kept{table->file, table->frame, {}};
  kept.rows.reserve(taken.size());
  for (const std::size_t i : taken) kept.rows.push_back(table->rows[i]);
  return kept;
}

}  // namespace

std::vector<std::size_t> evenlySpreadIndices(std::size_t count, std::size_t most) {
  std::vector<std::size_t> spread(std::min(count, most));
  for (std::size_t k = 0; k < spread.size(); ++k) spread[k] = k * count / spread.size();
  return spread;
}

namespace {

/// By posture, whether an unloaded state and one under load were read; of any load, or of these steps.
std::vector<bool> loadedPostures(const campaign::Campaign& campaign, const std::vector<int>& steps) {
  const std::size_t postures = campaign.pose_ids.size();
  std::vector<bool> at_rest(postures, false), loaded(postures, false);
  if (!campaign.states) return loaded;
  double largest = 0.0;
  for (const campaign::State& row : campaign.states->rows)
    largest = std::max(largest, row.wrench_in_cell.head<3>().norm());
  const auto counts = [&](int step) {
    return step != 0 && (steps.empty() || std::find(steps.begin(), steps.end(), step) != steps.end());
  };
  std::vector<std::pair<int, int>> under_load;
  for (const campaign::State& row : campaign.states->rows) {
    if (counts(row.step) && row.wrench_in_cell.head<3>().norm() > campaign::kReturnShare * largest)
      under_load.emplace_back(row.pose, row.step);
  }
  std::sort(under_load.begin(), under_load.end());
  const auto see = [&](int pose, int step) {
    const auto posture = static_cast<std::size_t>(pose);
    if (step == 0) at_rest[posture] = true;
    if (!loaded[posture] && std::binary_search(under_load.begin(), under_load.end(), std::pair(pose, step)))
      loaded[posture] = true;
  };
  if (campaign.loading) {
    for (const campaign::LoadingReading& row : campaign.loading->rows) see(row.pose, row.step);
  }
  if (campaign.displacements) {  // from the unloaded state by themselves
    for (const campaign::Displacement& row : campaign.displacements->rows) see(row.pose, 0), see(row.pose, row.step);
  }
  for (std::size_t p = 0; p < postures; ++p) loaded[p] = loaded[p] && at_rest[p];
  return loaded;
}

}  // namespace

std::vector<std::size_t> spreadPostures(const campaign::Campaign& campaign, std::size_t most,
                                        const std::vector<int>& steps) {
  const std::vector<bool> is_loaded = loadedPostures(campaign, steps);
  std::vector<std::size_t> loaded, others;
  for (std::size_t p = 0; p < is_loaded.size(); ++p) (is_loaded[p] ? loaded : others).push_back(p);
  std::vector<std::size_t> spread;
  for (const std::size_t k : evenlySpreadIndices(loaded.size(), most)) spread.push_back(loaded[k]);
  for (const std::size_t k : evenlySpreadIndices(others.size(), most - spread.size())) spread.push_back(others[k]);
  std::sort(spread.begin(), spread.end());
  return spread;
}

campaign::Campaign ofPostures(const campaign::Campaign& campaign, const std::vector<std::size_t>& postures,
                              std::size_t most_swept) {
  // All of a Campaign by name: one more member does not compile until it is copied here.
  const auto& [folder, name, date, texts, robot, base_link, flange_link, double_encoder, double_encoder_joints, gravity,
               mass_sigma, tracker, targets, load_cell, tool, known_stiffness, joint_readings, controller_model,
               circle_sweeps, wrist_sweep, rail_sweep, loading, states, displacements, nests, pose_ids, nest_ids,
               repeat_ids, stations, inputs] = campaign;
  std::vector<int> now(pose_ids.size(), kNotKept);
  std::vector<std::string> kept_ids;
  for (const std::size_t posture : postures) {
    now[posture] = static_cast<int>(kept_ids.size());
    kept_ids.push_back(pose_ids[posture]);
  }
  const int reflectors = static_cast<int>(targets.size());
  return {folder,
          name,
          date,
          texts,
          robot,
          base_link,
          flange_link,
          double_encoder,
          double_encoder_joints,
          gravity,
          mass_sigma,
          tracker,
          targets,
          load_cell,
          tool,
          known_stiffness,
          joint_readings,
          controller_model,
          ofReadings(circle_sweeps, most_swept,
                     [&](const campaign::CircleReading& row) { return row.axis * reflectors + row.target; }),
          ofReadings(wrist_sweep, most_swept, [](const campaign::WristReading& row) { return row.target; }),
          rail_sweep,
          rowsOf(loading, now),
          rowsOf(states, now),
          rowsOf(displacements, now),
          nests,
          kept_ids,
          nest_ids,
          repeat_ids,
          stations,
          inputs};
}

campaign::Campaign evenlySpread(const campaign::Campaign& campaign, std::size_t most, std::size_t most_swept,
                                const std::vector<int>& steps) {
  return ofPostures(campaign, spreadPostures(campaign, most, steps), most_swept);
}

std::size_t firstReflectors(const campaign::Campaign& campaign, std::size_t most) {
  const std::size_t all = campaign.targets.size();
  std::vector<bool> was_read(all, false);
  const auto see = [&](const auto& table) {
    if (!table) return;
    for (const auto& row : table->rows) was_read[static_cast<std::size_t>(row.target)] = true;
  };
  see(campaign.loading);
  see(campaign.displacements);
  std::size_t first = 0;
  for (std::size_t seen = 0; first < all && seen < most; ++first) seen += was_read[first] ? 1 : 0;
  return first;
}

campaign::Campaign ofFirstReflectors(campaign::Campaign campaign, std::size_t most) {
  const std::size_t kept = firstReflectors(campaign, most);
  const auto keep = [&](auto& table) {
    if (!table) return;
    std::erase_if(table->rows, [&](const auto& row) { return static_cast<std::size_t>(row.target) >= kept; });
    if (table->rows.empty()) table.reset();
  };
  keep(campaign.circle_sweeps);
  keep(campaign.wrist_sweep);
  keep(campaign.rail_sweep);
  keep(campaign.loading);
  keep(campaign.displacements);
  campaign.targets.resize(kept);
  return campaign;
}

bool hasLongSweep(const campaign::Campaign& campaign, std::size_t most_swept) {
  return (campaign.circle_sweeps && campaign.circle_sweeps->rows.size() > most_swept) ||
         (campaign.wrist_sweep && campaign.wrist_sweep->rows.size() > most_swept);
}

}  // namespace stiffscope::preparation
