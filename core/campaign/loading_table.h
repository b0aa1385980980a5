#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// One reading of one target in one load state.
inline const TableLayout<LoadingReading>& loadingLayout() {
  using Row = LoadingReading;
  static const TableLayout<Row> layout{
      "loading",
      joined<Row>({poseAndStepColumns<Row>(),
                   {{"repeat", CellKind::text, [](Row& row) -> std::string& { return row.repeat; }},
                    targetColumn<Row>(),
                    timeColumn<Row>(true)},
                   pointColumns<Row>()}),
      {"pose", "step", "repeat", "target"}};
  return layout;
}

}  // namespace stiffscope
