#include "core/mistakes/readings_of_day.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace stiffscope::mistakes {

namespace {

constexpr std::size_t kOfCircle = 6, kOfWrist = 60;
constexpr int kPostures = 40;
constexpr int kWristGroups = 6;

campaign::PointFrame frameOf(const campaign::Campaign& campaign) {
  if (campaign.loading) return campaign.loading->frame;
  if (campaign.circle_sweeps) return campaign.circle_sweeps->frame;
  return campaign::PointFrame::tracker;
}

/// `most` of `count` indices, spread evenly from the first to the last.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t size = std::min(count, most);
  // Rounded, so that a table read backwards has the same ones.
  for (std::size_t i = 0; i < size; ++i)
    chosen.push_back(size < 2 ? 0 : (2 * i * (count - 1) + size - 1) / (2 * (size - 1)));
  return chosen;
}

template <class Row>
void setNeighbours(const std::vector<const Row*>& rows, std::size_t at, UnloadedReading& reading) {
  reading.q_before = rows[at > 0 ? at - 1 : at]->q;
  reading.q_after = rows[at + 1 < rows.size() ? at + 1 : at]->q;
}

void addCircles(const campaign::Campaign& campaign, ReadingsOfDay& day) {
  if (!campaign.circle_sweeps || campaign.circle_sweeps->frame != frameOf(campaign)) return;
  std::map<std::pair<int, int>, std::vector<const campaign::CircleReading*>> circles;
  for (const campaign::CircleReading& row : campaign.circle_sweeps->rows)
    circles[{row.axis, row.target}].push_back(&row);
  int axis = -1;
  for (const auto& [key, rows] : circles) {
    if (key.first != axis) ++day.groups;
    axis = key.first;
    for (const std::size_t i : spread(rows.size(), kOfCircle)) {
      UnloadedReading reading;
      reading.table = SourceTable::circle_sweeps;
      reading.group = day.groups - 1;
      reading.axis = axis;
      reading.target = rows[i]->target;
      reading.q = rows[i]->q;
      setNeighbours(rows, i, reading);
      reading.point = rows[i]->point;
      reading.line = rows[i]->line;
      day.unloaded.push_back(reading);
    }
  }
}

void addWristSweep(const campaign::Campaign& campaign, ReadingsOfDay& day) {
  if (!campaign.wrist_sweep || campaign.wrist_sweep->frame != frameOf(campaign)) return;
  // Rows of one reflector: where three are read at each stop, the row before is most often the same stop.
  std::map<int, std::vector<const campaign::WristReading*>> by_target;
  for (const campaign::WristReading& row : campaign.wrist_sweep->rows) by_target[row.target].push_back(&row);
  const int first = day.groups;
  for (const auto& [target, rows] : by_target) {
    std::vector<std::size_t> chosen = spread(rows.size(), kOfWrist / by_target.size() + 2);
    // The rows at the ends have no neighbour on one side, by which a shift of rows could be told.
    if (chosen.size() > 4) chosen = {chosen.begin() + 1, chosen.end() - 1};
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      UnloadedReading reading;
      reading.table = SourceTable::wrist_sweep;
      reading.group = first + static_cast<int>(k * kWristGroups / chosen.size());
      day.groups = std::max(day.groups, reading.group + 1);
      reading.target = target;
      reading.q = rows[chosen[k]]->q;
      setNeighbours(rows, chosen[k], reading);
      reading.point = rows[chosen[k]]->point;
      reading.line = rows[chosen[k]]->line;
      day.unloaded.push_back(reading);
    }
  }
}

struct PointSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  std::size_t line = 0;
};

using PointsOfState = std::map<int, PointSum>;  ///< by target

/// Of the postures that are looked at.
std::map<std::pair<int, int>, PointsOfState> loadingPoints(const campaign::Campaign& campaign) {
  std::map<std::pair<int, int>, PointsOfState> points;
  if (!campaign.loading) return points;
  for (const campaign::LoadingReading& row : campaign.loading->rows) {
    if (row.pose >= kPostures) continue;
    PointSum& sum = points[{row.pose, row.step}][row.target];
    if (sum.count == 0) sum.line = row.line;
    sum.sum += row.point;
    ++sum.count;
  }
  return points;
}

/// Of a day that has no points.
void addDisplacements(const campaign::Displacements& table, const campaign::State& state, LoadedReading& reading) {
  if (!reading.moves.empty() || table.frame != campaign::PointFrame::base_link) return;
  for (const campaign::Displacement& row : table.rows) {
    if (row.pose == state.pose && row.step == state.step) reading.moves.push_back({row.target, row.displacement});
  }
}

void addPostures(const campaign::Campaign& campaign, ReadingsOfDay& day) {
  if (!campaign.states) return;
  const auto points = loadingPoints(campaign);
  std::vector<const campaign::State*> unloaded;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step == 0 && row.pose < kPostures) unloaded.push_back(&row);
  }
  std::map<int, const campaign::State*> first;
  for (std::size_t i = 0; i < unloaded.size(); ++i) {
    first[unloaded[i]->pose] = unloaded[i];
    const auto own = points.find({unloaded[i]->pose, 0});
    if (own == points.end()) continue;
    for (const auto& [target, sum] : own->second) {
      UnloadedReading reading;
      reading.group = day.groups;
      reading.pose = unloaded[i]->pose;
      reading.target = target;
      reading.q = unloaded[i]->q;
      setNeighbours(unloaded, i, reading);
      reading.point = sum.sum / sum.count;
      reading.line = sum.line;
      day.unloaded.push_back(reading);
    }
    ++day.groups;
  }
  for (const campaign::State& row : campaign.states->rows) {
    const auto start = first.find(row.pose);
    if (row.step == 0 || start == first.end()) continue;
    LoadedReading reading{row.pose, row.step, start->second->q, row.wrench_in_cell, {}, row.line};
    const auto before = points.find({row.pose, 0}), after = points.find({row.pose, row.step});
    if (before != points.end() && after != points.end()) {
      for (const auto& [target, sum] : after->second) {
        const auto from = before->second.find(target);
        if (from == before->second.end()) continue;
        reading.moves.push_back({target, sum.sum / sum.count - from->second.sum / from->second.count});
      }
    }
    if (campaign.displacements) addDisplacements(*campaign.displacements, row, reading);
    if (!reading.moves.empty() && row.wrench_in_cell.allFinite()) day.loaded.push_back(std::move(reading));
  }
}

/// Each reflector has three unknowns of its own: of ten thousand a fit would need gigabytes.
void keepFewTargets(ReadingsOfDay& day) {
  constexpr std::size_t kTargets = 20;
  std::vector<std::pair<int, int>> by_readings;  // less their count, target
  for (int k = 0; k < day.targets; ++k) by_readings.emplace_back(0, k);
  for (const UnloadedReading& reading : day.unloaded) --by_readings[static_cast<std::size_t>(reading.target)].first;
  for (const LoadedReading& reading : day.loaded) {
    for (const ReflectorMove& move : reading.moves) --by_readings[static_cast<std::size_t>(move.target)].first;
  }
  std::sort(by_readings.begin(), by_readings.end());
  if (by_readings.size() > kTargets) by_readings.resize(kTargets);
  std::vector<int> becomes(static_cast<std::size_t>(day.targets), -1);
  for (const auto& [count, target] : by_readings) day.campaign_target.push_back(target);
  std::sort(day.campaign_target.begin(), day.campaign_target.end());
  for (std::size_t k = 0; k < day.campaign_target.size(); ++k)
    becomes[static_cast<std::size_t>(day.campaign_target[k])] = static_cast<int>(k);
  day.targets = static_cast<int>(day.campaign_target.size());
  for (UnloadedReading& reading : day.unloaded) reading.target = becomes[static_cast<std::size_t>(reading.target)];
  std::erase_if(day.unloaded, [](const UnloadedReading& reading) { return reading.target < 0; });
  for (LoadedReading& reading : day.loaded) {
    for (ReflectorMove& move : reading.moves) move.target = becomes[static_cast<std::size_t>(move.target)];
    std::erase_if(reading.moves, [](const ReflectorMove& move) { return move.target < 0; });
  }
  std::erase_if(day.loaded, [](const LoadedReading& reading) { return reading.moves.empty(); });
  // Groups without a reading are none.
  std::map<int, int> groups;
  for (const UnloadedReading& reading : day.unloaded) groups.emplace(reading.group, 0);
  day.groups = 0;
  for (auto& [group, number] : groups) number = day.groups++;
  for (UnloadedReading& reading : day.unloaded) reading.group = groups.at(reading.group);
}

}  // namespace

ReadingsOfDay readingsOf(const campaign::Campaign& campaign) {
  ReadingsOfDay day;
  day.robot = campaign.robot;
  day.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, campaign.robot,
                                  Eigen::Isometry3d::Identity());
  day.targets = static_cast<int>(campaign.targets.size());
  addCircles(campaign, day);
  addWristSweep(campaign, day);
  addPostures(campaign, day);
  keepFewTargets(day);
  return day;
}

ReadingsOfDay withStepsExchanged(const ReadingsOfDay& as_read, int a, int b, bool of_points, std::optional<int> pose) {
  ReadingsOfDay day = as_read;
  std::map<std::pair<int, int>, const LoadedReading*> rows;
  for (const LoadedReading& row : as_read.loaded) rows[{row.pose, row.step}] = &row;
  for (LoadedReading& row : day.loaded) {
    if (pose && row.pose != *pose) continue;
    const int step = row.step == a ? b : row.step == b ? a : row.step;
    if (!of_points) {
      const auto from = rows.find({row.pose, step});
      if (from != rows.end()) row.wrench = from->second->wrench;
      continue;
    }
    // Displacements are against step 0: where that is one of the two, all have another start.
    for (ReflectorMove& move : row.moves) {
      const auto of = [&](int of_step) -> Eigen::Vector3d {
        const auto from = rows.find({row.pose, of_step});
        if (from == rows.end()) return Eigen::Vector3d::Zero();
        for (const ReflectorMove& other : from->second->moves) {
          if (other.target == move.target) return other.displacement;
        }
        return Eigen::Vector3d::Zero();
      };
      move.displacement = (step == 0 ? Eigen::Vector3d::Zero() : of(step)) - (a == 0 ? of(b) : Eigen::Vector3d::Zero());
    }
  }
  return day;
}

std::string fileOfAngles(const campaign::Campaign& campaign, SourceTable table) {
  if (table != SourceTable::loading) return fileOfPoints(campaign, table);
  return campaign.states ? campaign.states->file : std::string();
}

std::string fileOfPoints(const campaign::Campaign& campaign, SourceTable table) {
  switch (table) {
    case SourceTable::circle_sweeps:
      return campaign.circle_sweeps ? campaign.circle_sweeps->file : std::string();
    case SourceTable::wrist_sweep:
      return campaign.wrist_sweep ? campaign.wrist_sweep->file : std::string();
    case SourceTable::loading:
      break;
  }
  return campaign.loading ? campaign.loading->file : std::string();
}

}  // namespace stiffscope::mistakes
