#pragma once

#include "core/campaign/table_layout.h"
#include "core/campaign/tables.h"

namespace stiffscope {

/// A displacement of a target from step 0, for data without absolute points.
inline const TableLayout<Displacement>& displacementsLayout() {
  using Row = Displacement;
  static const TableLayout<Row> layout{
      "displacements",
      joined<Row>({poseAndStepColumns<Row>(),
                   {targetColumn<Row>(),
                    {"dx_mm", CellKind::displacement_millimetre,
                     [](Row& row) -> double& { return row.displacement.x(); }},
                    {"dy_mm", CellKind::displacement_millimetre,
                     [](Row& row) -> double& { return row.displacement.y(); }},
                    {"dz_mm", CellKind::displacement_millimetre,
                     [](Row& row) -> double& { return row.displacement.z(); }}}}),
      {"pose", "step", "target"}};
  return layout;
}

}  // namespace stiffscope
