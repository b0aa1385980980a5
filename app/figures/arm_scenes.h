#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/calibration/position_errors.h"
#include "core/identification/identify.h"
#include "render/arm_scene.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// The arm of load case `index` as it stands unloaded, with the displacements of reflectors and P_wrist as
/// measured and, where there is a `method` and it is available, as it predicts them and what it leaves:
/// residual = measured - predicted.
render::ArmPose armPose(const reports::ReportCampaign& one, std::size_t index,
                        std::optional<identification::Method> method);

/// The arm alone. Joint points: from the foot of axis 1 on each axis the point nearest to the one before, then
/// the flange. Axes of R0, origin on axis 1 at the height of base_link's origin, so that the floor is where the
/// robot stands (R0's own origin is at the height of axis 2).
render::ArmPose bareArm(const frames::Frames& frames, const robot::ArmPosture& posture);

/// Height of R0's origin above the floor of the scene, m.
double heightOfR0(const frames::Frames& frames);

/// The load case with the median |displacement| of P_wrist, or of the reflectors where P_wrist is not
/// measured (of an even number of cases the lower of the two in the middle). There must be a case.
std::size_t medianCase(const reports::ReportCampaign& one);

/// The arm in the posture of load case `index` with measured, predicted and residual displacement vectors; the
/// last two by `method`, and none without. The residual ones are longer by automaticResidualFactor.
render::ArmScene postureScene(const reports::ReportCampaign& one, std::size_t index,
                              std::optional<identification::Method> method);

/// The scene of the median posture (medianCase), by the method that the report shows.
render::ArmScene deflectionScene(const reports::ReportCampaign& one);

/// The scene of a campaign on the first page and the load case that it is of.
struct DeflectionScene {
  std::size_t load_case = 0;
  render::ArmScene scene;  ///< with its magnification
  std::string as_in = {};  ///< the campaign whose median posture this is; empty: its own (medianCase)
};

/// Of each campaign, empty of one without a load. Where all loaded ones measured the median posture of the first under
/// the same load (comparison::matchPostures), all show that posture, from one place and to one scale, so that their
/// arrows can be held against each other; else each its own.
std::vector<std::optional<DeflectionScene>> deflectionScenes(const std::vector<reports::ReportCampaign>& campaigns);

/// All postures, pale, with the displacement vectors of P_wrist alone (of the first reflector where P_wrist
/// is not measured).
render::ArmScene allPosturesScene(const reports::ReportCampaign& one);

/// The words for both; pictures are still to be drawn. `magnification` as drawn.
reports::Figure describeDeflectionScene(const reports::ReportCampaign& one, const DeflectionScene& drawn);
reports::Figure describeAllPostures(const reports::ReportCampaign& one, double magnification);

/// The gap between model and machine on the arm: what is left of each reflector's displacement, in the load
/// state of each posture that leaves the most; once by joint stiffnesses alone, once with the verdict's
/// effects in the model, to one scale and seen from one place.
struct GapScenes {
  render::ArmScene before, after;
};

/// What stiffnesses alone leave, or with the verdict's effects (PointGap::before, after).
using GapVector = Eigen::Vector3d diagnosis::PointGap::*;

/// The longest of all; there must be one. Pictures and scenes of a part of a day have the postures that captions name.
const diagnosis::PointGap& longestGap(const diagnosis::Diagnosis& diagnosis, GapVector left);

/// The postures (indices of the day's) that captions of a day without a load name: those that the calibrated geometry
/// and the effects miss most.
std::set<std::size_t> namedPostures(const calibration::Calibration& calibration,
                                    const std::vector<calibration::ReadingError>& errors);

inline constexpr std::size_t kMostArrows = 90;  ///< of a scene; more in one picture hide each other

/// To one scale; both fit both, so that they are seen alike.
void seeAlike(GapScenes& scenes);

/// Empty where nothing was diagnosed or nothing found. Where there are very many arrows, those of evenly
/// chosen postures are drawn.
std::optional<GapScenes> gapScenes(const reports::ReportCampaign& one);

/// The scenes of a day without a load: what the calibrated geometry leaves at each reflector, and what is left with the
/// effects in the model. Empty where the day could not be calibrated or nothing is left.
std::optional<GapScenes> accuracyScenes(const reports::ReportCampaign& one);

reports::Figure describeAccuracyBefore(const reports::ReportCampaign& one, const GapScenes& scenes);
reports::Figure describeAccuracyAfter(const reports::ReportCampaign& one, const GapScenes& scenes);

reports::Figure describeGapBefore(const reports::ReportCampaign& one, const GapScenes& scenes);
reports::Figure describeGapAfter(const reports::ReportCampaign& one, const GapScenes& scenes);

}  // namespace stiffscope::app
