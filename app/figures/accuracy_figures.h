#pragma once

#include "core/calibration/position_errors.h"
#include "render/point_chart.h"
#include "reports/report_content.h"

// Pictures of days without a load. All of them are of a campaign whose day could be calibrated.

namespace stiffscope::app {

/// Distribution of the 3-D position errors: share of the readings below an error, mm, a curve a model; all models, and
/// enlarged the calibrated ones whose largest error is half of the largest of all at most, where there are such. Held
/// out where there are folds.
render::PointChart accuracyCurves(const reports::ReportCampaign& one);
reports::Figure describeAccuracyCurves(const reports::ReportCampaign& one);

/// Places of the reflectors in base_link from above and from the side, coloured by the 3-D error, a column a model; one
/// scale of colours and of lengths. A part of very many readings is drawn.
render::PointChart accuracyMap(const reports::ReportCampaign& one);
reports::Figure describeAccuracyMap(const reports::ReportCampaign& one);

/// Measured less modelled over the day, um, along the tracker's beam and across it, by the calibrated geometry and with
/// the effects, with the means of twelfths of the day. Along base_link's axes where no tracker is declared.
render::PointChart residualsOverDay(const reports::ReportCampaign& one);
reports::Figure describeResidualsOverDay(const reports::ReportCampaign& one);

}  // namespace stiffscope::app
