#pragma once

#include "reports/report_content.h"
#include "reports/words/table.h"

namespace stiffscope::reports {

/// A row a posture, load step, measured point (reflectors, P_wrist) and available method: the displacement as it was
/// measured (effects of the model taken off), what the method predicts of it, and what is left, R0, mm.
DataTable postureTable(const ReportCampaign& one);

}  // namespace stiffscope::reports
