#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// One reading of one target while one axis turns and the others stand still.
inline const TableLayout<CircleReading>& circleSweepsLayout() {
  using Row = CircleReading;
  static const TableLayout<Row> layout{
      "circle_sweeps",
      joined<Row>({{{"axis", CellKind::axis, [](Row& row) -> int& { return row.axis; }},
                    {"index", CellKind::text, [](Row& row) -> std::string& { return row.index; }},
                    targetColumn<Row>()},
                   jointColumns<Row>(),
                   pointColumns<Row>(),
                   {timeColumn<Row>(false)}}),
      {"axis", "index", "target"}};
  return layout;
}

}  // namespace stiffscope
