#pragma once

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/campaign/cell_kind.h"

namespace stiffscope {

/// One column of a table: its name, what its cells hold, and the member of the row it stands for. Reading and
/// writing use the same description.
template <class Row>
struct Column {
  using Number = double& (*)(Row&);
  using Index = int& (*)(Row&);
  using Text = std::string& (*)(Row&);

  std::string name;
  CellKind kind;
  std::variant<Number, Index, Text> member;
  bool required = true;
};

/// A kind of table: the element of campaign.xml that names its file, its columns, and the columns that
/// together must not repeat.
template <class Row>
struct TableLayout {
  std::string element;
  std::vector<Column<Row>> columns;
  std::vector<std::string> key;
};

/// q1_deg..q6_deg, of a row with a member q.
template <class Row>
std::vector<Column<Row>> jointColumns() {
  return []<int... I>(std::integer_sequence<int, I...>) {
    return std::vector<Column<Row>>{{std::string{'q', static_cast<char>('1' + I)} + "_deg", CellKind::degree,
                                     [](Row& row) -> double& { return row.q[I]; }}...};
  }
  (std::make_integer_sequence<int, 6>());
}

/// fx_n..mz_nm, of a row with a member wrench_in_cell.
template <class Row>
std::vector<Column<Row>> wrenchColumns() {
  return {{"fx_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[0]; }},
          {"fy_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[1]; }},
          {"fz_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[2]; }},
          {"mx_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[3]; }},
          {"my_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[4]; }},
          {"mz_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[5]; }}};
}

/// x_mm, y_mm, z_mm, of a row with a member point.
template <class Row>
std::vector<Column<Row>> pointColumns() {
  return {{"x_mm", CellKind::millimetre, [](Row& row) -> double& { return row.point.x(); }},
          {"y_mm", CellKind::millimetre, [](Row& row) -> double& { return row.point.y(); }},
          {"z_mm", CellKind::millimetre, [](Row& row) -> double& { return row.point.z(); }}};
}

/// time_s, of a row with a member time_s.
template <class Row>
Column<Row> timeColumn(bool required) {
  return {"time_s", CellKind::second, [](Row& row) -> double& { return row.time_s; }, required};
}

/// pose and step, of a row with these members.
template <class Row>
std::vector<Column<Row>> poseAndStepColumns() {
  return {{"pose", CellKind::pose, [](Row& row) -> int& { return row.pose; }},
          {"step", CellKind::step, [](Row& row) -> int& { return row.step; }}};
}

template <class Row>
Column<Row> targetColumn() {
  return {"target", CellKind::target, [](Row& row) -> int& { return row.target; }};
}

/// Several groups of columns as one list.
template <class Row>
std::vector<Column<Row>> joined(std::initializer_list<std::vector<Column<Row>>> groups) {
  std::vector<Column<Row>> all;
  for (const auto& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace stiffscope
