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
           wrenchColumns<Row>()}),
      {"pose", "step"}};
  return layout;
}

}  // namespace stiffscope
