#pragma once

#include <optional>

#include "core/frames/gravity_sag.h"
#include "render/point_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// The sweeps' readings as the frames of the identification were fitted to: the own weight's sag taken off
/// where it was taken off there.
frames::RigidPoints rigidSweeps(const reports::ReportCampaign& one);

/// The circles of every measured axis with their radial residuals, rho - r, magnified: a ring a reflector,
/// rings of equal distance (their radii are not to scale), the angle that of the joint. Empty where no axis
/// was swept.
std::optional<render::PointChart> sweepCircles(const reports::ReportCampaign& one, const frames::RigidPoints& points);

reports::Figure describeSweepCircles(const reports::ReportCampaign& one);

/// Radial residuals of the wrist's spheres, |x - P_wrist| - r, um, against where on the sphere the reflector
/// stood: azimuth about R0's z, and elevation above its level plane. A line through the means of sectors.
/// Empty where the wrist centre is not measured.
std::optional<render::PointChart> wristSphere(const reports::ReportCampaign& one, const frames::RigidPoints& points);

reports::Figure describeWristSphere(const reports::ReportCampaign& one);

}  // namespace stiffscope::app
