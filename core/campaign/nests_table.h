#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// One reading of a reflector that stands on the floor.
inline const TableLayout<NestReading>& nestsLayout() {
  using Row = NestReading;
  static const TableLayout<Row> layout{
      "nests",
      joined<Row>(
          {{timeColumn<Row>(true), {"nest", CellKind::nest, [](Row& row) -> int& { return row.nest; }}},
           pointColumns<Row>()}),
      {"time_s", "nest"}};
  return layout;
}

}  // namespace stiffscope
