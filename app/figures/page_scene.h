#pragma once

#include <optional>
#include <set>
#include <string>

#include "app/figures/arm_scenes.h"
#include "core/extended_model/extended_model.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// The arm in the page, to be turned: what reports/page/scene.js draws, as JSON. Lengths in mm (to 0.01), vectors in µm
/// (to 0.01), axes of R0, its origin lifted to the floor as in the pictures; colours those of the pictures.
///   campaign, postures (how many the day has), origin,
///   palette {light, dark: name -> [r, g, b]}, corrected (whether `m` is corrected for `e`),
///   magnification, residual_factor, first (index of the frame to start with), methods [{key, name}],
///   vectors [{key, name, colour, width}]: the kinds there are, m (measured), p (predicted), r (residual), e (effects);
///   frames [{id, where, load, posture, step, joints, axes, force, points [{label, at, wrist, m, p {method}, r, e}]}],
///   traces [{axis, points}] of circle sweeps.
/// A residual that is not stated is m - p.
///
/// Of a loaded day every posture under every load step, as the desktop's viewer has it. `raw`: the day as it was before
/// it was corrected for the effects of `one.improved`; what these took away is vector e. The rows of the load states
/// must still be there. At most kMostScenePostures postures, evenly chosen, and those
/// that captions name.
std::string loadedSceneJson(const reports::ReportCampaign& one, const campaign::Campaign& raw);

/// The same scene, which begins as that of the first page's picture: in its posture, to its scale, from its view. Made
/// by loadedSceneJson while the rows are there; only when all campaigns are read is it known how they are seen alike.
std::string beginningAs(const std::string& scene, const reports::ReportCampaign& one, const DeflectionScene& picture);

/// Of an unloaded day what the calibrated geometry leaves at each reflector (m), what the effects explain of it (e) and
/// what is left (r). Empty where the day could not be calibrated.
std::string accuracySceneJson(const reports::ReportCampaign& one);

/// Of a day of sweeps the arm in the middle of each sweep with the readings. Empty where these do not place R0.
std::string sweepSceneJson(const reports::ReportCampaign& one);

/// Poses that a loaded day's captions name: with the longest displacement, the longest residual of the method shown,
/// and what the diagnosis leaves the most of.
std::set<int> namedPoses(const reports::ReportCampaign& one);

inline constexpr std::size_t kMostScenePostures = 60;

}  // namespace stiffscope::app
