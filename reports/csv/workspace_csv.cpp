#include "reports/csv/posture_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <array>
#include <cmath>
#include <initializer_list>

#include "core/io/units.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::reports {

namespace {

constexpr std::array kPrincipalNames{"softest", "middle", "stiffest"};

/// Which of up to three directions, softest first, has that name; -1: none.
int principalAt(std::size_t count, std::size_t name) {
  if (name == 0) return count > 0 ? 0 : -1;
  if (name == 1) return count > 2 ? 1 : -1;
  return count > 1 ? static_cast<int>(count) - 1 : -1;
}

void addPrincipalColumns(const std::string& prefix, std::vector<std::string>& columns) {
  for (const char* name : kPrincipalNames) {
    for (const char* part : {"n_per_um", "low_n_per_um", "high_n_per_um", "direction_x", "direction_y", "direction_z"})
      columns.push_back(fmt::format("{}_{}_{}", prefix, name, part));
  }
}

void addPrincipals(const std::vector<workspace::DirectionalCompliance>& found, std::vector<DataCell>& row) {
  for (std::size_t name = 0; name < kPrincipalNames.size(); ++name) {
    const int at = principalAt(found.size(), name);
    if (at < 0) {
      row.resize(row.size() + 6);
      continue;
    }
    const workspace::DirectionalCompliance& one = found[static_cast<std::size_t>(at)];
    const identification::CoverageInterval interval = one.stiffnessInterval();
    for (const double stiffness : {one.stiffness(), interval.low, interval.high})
      row.emplace_back(stiffness * io::kMicrometre);
    for (const double component : one.direction) row.emplace_back(component);
  }
}

void addPlace(const char* kind, const std::string& pose, const workspace::PointStiffness& place, DataTable& table) {
  std::vector<DataCell> row{std::string(kind), pose};
  for (const double q : place.q) row.emplace_back(q / io::kDegree);
  for (const double coordinate : place.tcp) row.emplace_back(coordinate / io::kMillimetre);
  row.emplace_back(std::hypot(place.tcp.x(), place.tcp.y()) / io::kMillimetre);
  row.emplace_back(place.conditioning);
  std::vector<int> unknown;
  for (const int joint : place.unknown) unknown.push_back(joint + 1);
  row.emplace_back(fmt::format("{}", fmt::join(unknown, " ")));
  addPrincipals(place.of_springs, row);
  addPrincipals(place.of_model, row);
  table.rows.push_back(std::move(row));
}

}  // namespace

DataTable stiffnessPlaces(const workspace::WorkspaceStiffness& found, int joints, bool postures, bool slice) {
  DataTable table;
  table.columns = {"place", "pose"};
  for (int joint = 1; joint <= joints; ++joint) table.columns.push_back(fmt::format("q{}_deg", joint));
  for (const char* column : {"tcp_x_mm", "tcp_y_mm", "tcp_z_mm", "radius_mm", "conditioning", "unknown_joints"})
    table.columns.emplace_back(column);
  addPrincipalColumns("springs", table.columns);
  addPrincipalColumns("model", table.columns);
  if (postures) {
    for (const workspace::PointStiffness& one : found.postures) addPlace("posture", one.pose, one, table);
  }
  if (slice) {
    for (const workspace::SlicePlace& one : found.slice.places) addPlace("slice", found.slice.pose, one.at, table);
  }
  return table;
}

DataTable placementTable(const workspace::PlacementStudy& study) {
  DataTable table;
  table.columns = {"offset",           "dx_mm",         "dy_mm",           "dz_mm",           "judged",
                   "postures_reached", "deflection_mm", "u_deflection_mm", "deflection_x_mm", "deflection_y_mm",
                   "deflection_z_mm",  "worst_pose",    "reason"};
  for (std::size_t i = 0; i < study.placements.size(); ++i) {
    const workspace::Placement& one = study.placements[i];
    std::vector<DataCell> row{one.offset.id};
    for (const double by : one.offset.by) row.emplace_back(by / io::kMillimetre);
    row.emplace_back(one.judged() ? 1.0 : 0.0);
    row.emplace_back(static_cast<double>(one.reached));
    if (one.judged()) {
      row.emplace_back(one.deflection() / io::kMillimetre);
      row.emplace_back(one.prediction.tcp.expanded / io::kMillimetre);
      for (const double part : one.prediction.tcp.deflection) row.emplace_back(part / io::kMillimetre);
    } else {
      row.resize(row.size() + 5);
    }
    row.emplace_back(one.worst);
    row.emplace_back(notJudgedWords(one, study.postures.size()));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace stiffscope::reports
