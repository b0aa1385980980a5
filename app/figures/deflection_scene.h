#pragma once

#include <cstddef>
#include <optional>

#include "render/arm_scene.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The load case with the median |displacement| of P_wrist, or of the reflectors where P_wrist is not
/// measured (of an even number of cases the lower of the two in the middle). There must be a case.
std::size_t medianCase(const ReportCampaign& one);

/// The arm in the posture of load case `index` with measured, predicted and residual displacement vectors; the
/// last two by `method`, and none without. The residual ones are longer by automaticResidualFactor.
ArmScene postureScene(const ReportCampaign& one, std::size_t index, std::optional<Method> method);

/// The same of that median posture, by the method that the report shows.
ArmScene deflectionScene(const ReportCampaign& one);

/// All postures, pale, with the displacement vectors of P_wrist alone (of the first reflector where P_wrist
/// is not measured).
ArmScene allPosturesScene(const ReportCampaign& one);

/// The words for both; pictures are still to be drawn. `magnification` as drawn.
Figure describeDeflectionScene(const ReportCampaign& one, double magnification);
Figure describeAllPostures(const ReportCampaign& one, double magnification);

}  // namespace stiffscope
