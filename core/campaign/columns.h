#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "core/io/units.h"
#include "core/robot/robot.h"

namespace stiffscope::campaign {

/// Names in order of first appearance, each with its index; looking one up makes no string.
class NameList {
 public:
  /// Index of `name`, -1 where it is not listed.
  int find(std::string_view name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }

  /// Index of `name`, which is appended where it is not listed yet.
  int add(std::string_view name) {
    // Rows of one posture follow one another.
    if (!names_.empty() && names_[static_cast<std::size_t>(latest_)] == name) return latest_;
    latest_ = find(name);
    if (latest_ >= 0) return latest_;
    latest_ = static_cast<int>(names_.size());
    names_.emplace_back(name);
    index_.emplace(names_.back(), latest_);
    return latest_;
  }

  /// Adds those of another list, in their order; the index here of each of them.
  std::vector<int> addAll(const NameList& others) {
    std::vector<int> indices;
    indices.reserve(others.names_.size());
    for (const std::string& name : others.names_) indices.push_back(add(name));
    return indices;
  }

  const std::vector<std::string>& names() const { return names_; }

  static NameList of(std::string_view first) {
    NameList list;
    list.add(first);
    return list;
  }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };

  std::vector<std::string> names_;
  int latest_ = 0;
  std::unordered_map<std::string, int, Hash, std::equal_to<>> index_;
};

/// The identifiers that table rows refer to by index. Targets are those that campaign.xml declares; poses and
/// nests are listed as the tables bring them, in order of first appearance.
struct CampaignNames {
  NameList targets, poses, nests;
  int axes = 0;                          ///< that the machine has, for columns that name one
  NameList stations = NameList::of("");  ///< as nests; the first is that of rows that name none
  NameList repeats = {};                 ///< as nests; those that are no whole number
};

/// What a column holds. The first eight are numbers with the unit of their name, the others names and counts.
enum class CellKind {
  millimetre,
  displacement_millimetre,
  degree,
  second,
  newton,
  newton_metre,
  celsius,
  ratio,
  axis,    ///< from 1 in the file, from 0 in memory
  step,    ///< 0, 1, 2...
  target,  ///< id of a declared target
  pose,
  nest,
  station,  ///< of the tracker
  repeat,
  text
};

/// How a kind of number is written, and what is plausible: the limits only catch what cannot be meant,
/// such as a force in a column of angles.
struct NumberKind {
  double si_per_unit = 1.0;
  double limit = 0.0;  ///< largest magnitude, in the file's unit
  const char* expectation = "";
  int decimals = 0;  ///< written
};

// In the order of CellKind.
inline constexpr std::array<NumberKind, 8> kNumberKinds{{
    {io::kMillimetre, 200e3, "expected a coordinate in mm, within +-200 m", 4},
    {io::kMillimetre, 1e3, "expected a displacement from step 0 in mm, within +-1 m", 4},
    {io::kDegree, 720.0, "expected an angle in degrees, within +-720", 5},
    {1.0, std::numeric_limits<double>::infinity(), "expected a time in seconds", 1},
    {1.0, 1e6, "expected a force in N, within +-1e6", 3},
    {1.0, 1e6, "expected a moment in Nm, within +-1e6", 4},
    {1.0, 200.0, "expected a temperature in degrees Celsius, within +-200", 2},
    {1.0, 1.0 + 1e-6, "expected a number within +-1", 9},  // of a unit vector, rounded
}};

/// Throws std::out_of_range for a kind that is no number.
inline const NumberKind& numberKind(CellKind kind) { return kNumberKinds.at(static_cast<std::size_t>(kind)); }

/// Where a cell stands; the column as the header names it.
struct CellPlace {
  const std::string& file;
  std::size_t line;
  std::string_view column;
};

/// A cell as a number in SI and radians. Throws InputError where it is none, or not plausible.
double readNumberCell(CellKind kind, std::string_view cell, const CellPlace& place);

/// A cell that is kept as an index: axis, step, target, pose, nest, station, repeat. Throws InputError.
int readIndexCell(CellKind kind, std::string_view cell, const CellPlace& place, CampaignNames& names);

/// What LoadingReading::repeat keeps of the text. A whole number is one as numbers are written: "1" and "01" stay two.
int repeatOf(std::string_view text, NameList& names);

/// A cell that is kept as it is; throws InputError where it is empty.
std::string readTextCell(std::string_view cell, const CellPlace& place);

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
  bool may_be_blank = false;  ///< a number that a row need not have: its member then stays as it is by default
  std::string together = {};  ///< optional columns of one such name are there all or none
};

/// A kind of table: the element of campaign.xml that names its file, its columns, and the columns that
/// together must not repeat.
template <class Row>
struct TableLayout {
  std::string element;
  std::vector<Column<Row>> columns;
  std::vector<std::string> key;
  Row blank = {};  ///< a row before its cells are read
};

/// An angle of each of so many joints, as q1_deg, q2_deg.. for the letter q, of a row with that member, or of what a
/// function gives of a row.
template <class Row, auto Member>
std::vector<Column<Row>> angleColumns(char letter, int joints, bool required) {
  std::vector<Column<Row>> columns = [=]<int... I>(std::integer_sequence<int, I...>) {
    return std::vector<Column<Row>>{{std::string{letter, static_cast<char>('1' + I)} + "_deg", CellKind::degree,
                                     [](Row& row) -> double& { return std::invoke(Member, row).data()[I]; }, required,
                                     !required}...};
  }
  (std::make_integer_sequence<int, kMostJoints>());
  columns.resize(static_cast<std::size_t>(joints));
  return columns;
}

/// q1_deg.. of so many joints, of a row with a member q.
template <class Row>
std::vector<Column<Row>> jointColumns(int joints) {
  return angleColumns<Row, &Row::q>('q', joints, true);
}

/// rail_mm, of a row with a member rail. Tables of a robot on a rail have it (checkCampaign).
template <class Row>
Column<Row> railColumn(bool required = false) {
  return {"rail_mm", CellKind::millimetre, [](Row& row) -> double& { return row.rail; }, required};
}

/// A row with a member q of so many joints, all at zero.
template <class Row>
Row blankRow(int joints) {
  Row row;
  row.q = JointVector::Zero(joints);
  return row;
}

/// fx_n..mz_nm, of a row with a member wrench_in_cell. Not required: all or none of them, and with none nothing pulls.
template <class Row>
std::vector<Column<Row>> wrenchColumns(bool required = true) {
  std::vector<Column<Row>> columns{
      {"fx_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[0]; }},
      {"fy_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[1]; }},
      {"fz_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[2]; }},
      {"mx_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[3]; }},
      {"my_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[4]; }},
      {"mz_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[5]; }}};
  for (Column<Row>& column : columns) {
    column.required = required;
    if (!required) column.together = "wrench";
  }
  return columns;
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

/// station, of a row with this member. Not required, and a row may leave it blank.
template <class Row>
Column<Row> stationColumn() {
  return {"station", CellKind::station, [](Row& row) -> int& { return row.station; }, false, true};
}

/// Several groups of columns as one list.
template <class Row>
std::vector<Column<Row>> joined(std::initializer_list<std::vector<Column<Row>>> groups) {
  std::vector<Column<Row>> all;
  for (const auto& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace stiffscope::campaign
