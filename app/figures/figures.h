#pragma once

#include <optional>
#include <vector>

#include "core/diagnosis/spike_study.h"
#include "core/frames/gravity_sag.h"
#include "core/preparation/drift_nests.h"
#include "render/dot_row_chart.h"
#include "render/grouped_bar_chart.h"
#include "render/interval_chart.h"
#include "render/point_chart.h"
#include "render/spread_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

struct FigureOptions {
  /// The paper's means as dashed lines where the campaign's double encoders are declared, and which of its figures ours
  /// are the counterparts of.
  bool with_paper = false;
};

/// All pictures of a report, drawn: per campaign the deflection scene, all postures (up to 60), Fig. 7, Fig.
/// 8 (where PP and DPP both are available), the spread over subsets, the stiffnesses; what
/// is left by direction, the sweeps' circles and spheres, the station by the floor nests; what the model
/// misses, on the arm, by posture and by effect; then the double encoders where both states are there. What
/// the data does not have is left out. No id is that of a section of the page. With several campaigns ids end
/// in "-1", "-2", in their order, and titles say which campaign. `avoided`: by the double encoders, of these
/// campaigns. Throws std::runtime_error when offscreen rendering is not to be had.
std::vector<reports::Figure> makeFigures(const std::vector<reports::ReportCampaign>& campaigns,
                                         const FigureOptions& options = {},
                                         const std::optional<reports::AvoidedByEncoders>& avoided = {});

/// Joint stiffnesses from all postures by method with their 95 % intervals (identification::stiffnessInterval; value +-
/// expanded uncertainty where none is stated), Nm/rad, logarithmic axis. A joint that is not identifiable leaves a gap;
/// negative and imprecise values are hollow. No series where no method is available.
render::IntervalChart stiffnessIntervals(const reports::ReportCampaign& one);

reports::Figure describeStiffnessIntervals(const reports::ReportCampaign& one);

/// Table II as a picture: the distribution of each identifiable joint's stiffness over the subsets of
/// postures, by method, 10^6 Nm/rad. `with_paper` draws the paper's mean where the campaign declares its
/// double encoders. No panel where no method has subsets.
render::SpreadChart subsetSpreads(const reports::ReportCampaign& one, bool with_paper);

reports::Figure describeSubsetSpreads(const reports::ReportCampaign& one);

/// |displacement| per posture with the double encoders inactive and active, mm. `avoided` must be available.
render::GroupedBarChart encoderBars(const reports::AvoidedByEncoders& avoided);

reports::Figure describeEncoderBars(const reports::AvoidedByEncoders& avoided);

/// The paper's Fig. 7: per posture |displacement| of P_wrist without compensation and after each available
/// method, mm; where P_wrist is not measured, at the reflectors, and the title says so. Each posture is
/// judged by stiffnesses that it took no part in.
render::GroupedBarChart residualBars(const reports::ReportCampaign& one);

/// The paper's Fig. 8: what PP and DPP leave, by themselves. No series where neither is available.
render::GroupedBarChart residualZoom(const reports::ReportCampaign& one);

reports::Figure describeResidualBars(const reports::ReportCampaign& one, bool with_paper = false);
reports::Figure describeResidualZoom(const reports::ReportCampaign& one, bool with_paper = false);

/// What the shown method leaves of each reflector's displacement, b - A c: by posture, reflector and direction
/// along the beam, across it level (to R0's z) and across it upright, in um; where the tracker's noise is
/// declared and points are absolute, in a second row in parts of the standard deviation that this noise gives
/// the displacement. Without them along R0's axes. Empty where no method is available.
std::optional<render::PointChart> residualDirections(const reports::ReportCampaign& one);

reports::Figure describeResidualDirections(const reports::ReportCampaign& one, const render::PointChart& chart);

/// Which effects these postures and loads can tell apart: a row an effect with the smallest size that would
/// have been seen (um), a column a class of effects that they cannot tell apart, the verdict's effects
/// marked; what cannot be tested says what is missing. Empty where nothing was diagnosed.
std::optional<render::DotRowChart> effectClasses(const reports::ReportCampaign& one);

reports::Figure describeEffectClasses(const reports::ReportCampaign& one);

/// The gap of the deflection by posture: what joint stiffnesses alone leave, what is left with the verdict's
/// effects in the model, and what noise alone would leave, rms per coordinate, um. Empty where nothing was
/// diagnosed.
std::optional<render::GroupedBarChart> gapBars(const reports::ReportCampaign& one);

reports::Figure describeGapBars(const reports::ReportCampaign& one);

/// Compliance ellipses in the slice's plane: how far P_TCP moves under a force of one size in each direction of the
/// plane, to scale; by the whole model in colours of the softest stiffness there, by joint springs alone (K_x) in grey
/// where the model has more. The arm stands in the slice's posture.
render::PointChart stiffnessSliceChart(const campaign::Campaign& campaign, const frames::Frames& frames,
                                       const workspace::WorkspaceStiffness& found);
render::PointChart stiffnessSliceChart(const reports::ReportCampaign& one);
reports::Figure describeStiffnessSlice(const reports::ReportCampaign& one);

/// Principal stiffnesses of the whole model at P_TCP by posture with their 95 % intervals, N/um, logarithmic.
render::IntervalChart postureStiffnessChart(const reports::ReportCampaign& one);
reports::Figure describePostureStiffness(const reports::ReportCampaign& one);

/// The sweeps' readings to which the frames of the identification were fitted: corrected for the gravity sag
/// where they were corrected there.
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

/// How the tracker's station moved over the day by the floor nests: displacement where the arm stands and
/// rotation, with 2 standard uncertainties by the declared noise, and how far each nest was read from its first
/// reading. Axes of the tracker. Empty where the nests cannot tell.
std::optional<render::PointChart> stationDrift(const reports::ReportCampaign& one,
                                               const preparation::StationMotion& station);

reports::Figure describeStationDrift(const preparation::StationMotion& station);

/// By the declared noise; not tested where none is declared.
preparation::StationMotion stationMotionOf(const campaign::Campaign& campaign);

/// What `diagnose --spike` counts: a panel an effect with the share of draws over the size, %: named, named with its
/// part, and something else said. None where no effect was added.
std::optional<render::PointChart> spikeCurves(const campaign::Campaign& campaign, const diagnosis::Diagnosis& baseline,
                                              const diagnosis::SpikeStudy& study);

}  // namespace stiffscope::app
