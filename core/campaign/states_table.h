#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// Joint angles and load-cell reading of one load state.
inline const TableLayout<State>& statesLayout() {
  using Row = State;
  static const TableLayout<Row> layout{
      "states",
      joined<Row>(
          {poseAndStepColumns<Row>(),
           {timeColumn<Row>(true)},
           jointColumns<Row>(),
           {{"fx_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[0]; }},
            {"fy_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[1]; }},
            {"fz_n", CellKind::newton, [](Row& row) -> double& { return row.wrench_in_cell[2]; }},
            {"mx_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[3]; }},
            {"my_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[4]; }},
            {"mz_nm", CellKind::newton_metre, [](Row& row) -> double& { return row.wrench_in_cell[5]; }}}}),
      {"pose", "step"}};
  return layout;
}

}  // namespace stiffscope
