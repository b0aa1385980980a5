#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// One reading with axes 1-3 standing still and 4-6 anywhere.
inline const TableLayout<WristReading>& wristSweepLayout() {
  using Row = WristReading;
  static const TableLayout<Row> layout{
      "wrist_sweep",
      joined<Row>({{{"index", CellKind::text, [](Row& row) -> std::string& { return row.index; }},
                    targetColumn<Row>()},
                   jointColumns<Row>(),
                   pointColumns<Row>(),
                   {timeColumn<Row>(false)}}),
      {"index", "target"}};
  return layout;
}

}  // namespace stiffscope
