#pragma once

#include "core/workspace/workspace_stiffness.h"
#include "reports/report_content.h"
#include "reports/words/table.h"

namespace stiffscope::reports {

/// A row a posture, then a row a place of the slice: joint angles, P_TCP in R0, and in each the softest, middle and
/// stiffest direction of K_x and of the whole model with the ends of their intervals. `joints`: of the machine.
/// `postures`, `slice`: which of them.
DataTable stiffnessPlaces(const workspace::WorkspaceStiffness& found, int joints, bool postures, bool slice);

/// A row an offset of the workpiece.
DataTable placementTable(const workspace::PlacementStudy& study);

/// A row a posture, load step, measured point (reflectors, P_wrist) and available method: the displacement as it was
/// measured (effects of the model taken off), what the method predicts of it, and what is left, R0, mm.
DataTable postureTable(const ReportCampaign& one);

}  // namespace stiffscope::reports
