#pragma once

#include "core/campaign/campaign.h"
#include "core/campaign/columns.h"

namespace stiffscope::campaign {

// Of a machine of so many joints where angles are among the columns.

/// One reading of one target while one axis turns and the others stand still.
inline TableLayout<CircleReading> circleSweepsLayout(int joints) {
  using Row = CircleReading;
  return {"circle_sweeps",
          joined<Row>({{{"axis", CellKind::axis, [](Row& row) -> int& { return row.axis; }},
                        {"index", CellKind::text, [](Row& row) -> std::string& { return row.index; }},
                        targetColumn<Row>()},
                       jointColumns<Row>(joints),
                       {railColumn<Row>()},
                       pointColumns<Row>(),
                       {timeColumn<Row>(false), stationColumn<Row>()}}),
          {"axis", "index", "target"},
          blankRow<Row>(joints)};
}

/// A displacement of a target from step 0, for data without absolute points.
inline const TableLayout<Displacement>& displacementsLayout() {
  using Row = Displacement;
  static const TableLayout<Row> layout{
      "displacements",
      joined<Row>(
          {poseAndStepColumns<Row>(),
           {targetColumn<Row>(),
            {"dx_mm", CellKind::displacement_millimetre, [](Row& row) -> double& { return row.displacement.x(); }},
            {"dy_mm", CellKind::displacement_millimetre, [](Row& row) -> double& { return row.displacement.y(); }},
            {"dz_mm", CellKind::displacement_millimetre, [](Row& row) -> double& { return row.displacement.z(); }},
            stationColumn<Row>()}}),
      {"pose", "step", "target"}};
  return layout;
}

/// One reading of one target in one load state.
inline const TableLayout<LoadingReading>& loadingLayout() {
  using Row = LoadingReading;
  static const TableLayout<Row> layout{
      "loading",
      joined<Row>({poseAndStepColumns<Row>(),
                   {{"repeat", CellKind::repeat, [](Row& row) -> int& { return row.repeat; }, false},
                    targetColumn<Row>(),
                    timeColumn<Row>(false)},
                   pointColumns<Row>(),
                   {stationColumn<Row>()}}),
      {"pose", "step", "repeat", "target"}};
  return layout;
}

/// One reading of a reflector that stands on the floor.
inline const TableLayout<NestReading>& nestsLayout() {
  using Row = NestReading;
  static const TableLayout<Row> layout{
      "nests",
      joined<Row>({{timeColumn<Row>(true), {"nest", CellKind::nest, [](Row& row) -> int& { return row.nest; }}},
                   pointColumns<Row>(),
                   {stationColumn<Row>()}}),
      {"time_s", "nest"}};
  return layout;
}

/// px_mm to pz_mm and pw_deg to pr_deg: where the controller states its tool. Three of a kind are there together.
inline std::vector<Column<State>> toolPoseColumns() {
  using Row = State;
  std::vector<Column<Row>> columns{
      {"px_mm", CellKind::millimetre, [](Row& row) -> double& { return row.extras().tool_pose.position.x(); }},
      {"py_mm", CellKind::millimetre, [](Row& row) -> double& { return row.extras().tool_pose.position.y(); }},
      {"pz_mm", CellKind::millimetre, [](Row& row) -> double& { return row.extras().tool_pose.position.z(); }},
      {"pw_deg", CellKind::degree, [](Row& row) -> double& { return row.extras().tool_pose.rpy.x(); }},
      {"pp_deg", CellKind::degree, [](Row& row) -> double& { return row.extras().tool_pose.rpy.y(); }},
      {"pr_deg", CellKind::degree, [](Row& row) -> double& { return row.extras().tool_pose.rpy.z(); }}};
  for (Column<Row>& column : columns) {
    column.required = false;
    column.may_be_blank = true;
    column.together = column.kind == CellKind::millimetre ? "tool position" : "tool turn";
  }
  return columns;
}

inline JointVector& commandedOf(State& row) { return row.extras().commanded; }
inline JointVector& motorSideOf(State& row) { return row.extras().motor_side; }

/// Joint angles and load-cell reading of one load state.
inline TableLayout<State> statesLayout(int joints) {
  using Row = State;
  return {"states",
          joined<Row>({poseAndStepColumns<Row>(),
                       {timeColumn<Row>(false)},
                       jointColumns<Row>(joints),
                       {railColumn<Row>()},
                       wrenchColumns<Row>(false),
                       angleColumns<Row, commandedOf>('c', joints, false),
                       angleColumns<Row, motorSideOf>('m', joints, false),
                       {{"temperature_c", CellKind::celsius,
                         [](Row& row) -> double& { return row.extras().temperature_c; }, false, true}},
                       toolPoseColumns()}),
          {"pose", "step"},
          State(joints)};
}

/// One reading with the arm's axes standing still and the wrist's anywhere.
inline TableLayout<WristReading> wristSweepLayout(int joints) {
  using Row = WristReading;
  return {
      "wrist_sweep",
      joined<Row>({{{"index", CellKind::text, [](Row& row) -> std::string& { return row.index; }}, targetColumn<Row>()},
                   jointColumns<Row>(joints),
                   {railColumn<Row>()},
                   pointColumns<Row>(),
                   {timeColumn<Row>(false), stationColumn<Row>()}}),
      {"index", "target"},
      blankRow<Row>(joints)};
}

/// One reading while the carriage of a rail goes along and all joints stand still.
inline const TableLayout<RailReading>& railSweepLayout() {
  using Row = RailReading;
  static const TableLayout<Row> layout{
      "rail_sweep",
      joined<Row>({{{"index", CellKind::text, [](Row& row) -> std::string& { return row.index; }}, targetColumn<Row>()},
                   {railColumn<Row>(true)},
                   pointColumns<Row>(),
                   {timeColumn<Row>(false), stationColumn<Row>()}}),
      {"index", "target"}};
  return layout;
}

}  // namespace stiffscope::campaign
