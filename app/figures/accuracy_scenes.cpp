#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "app/figures/arm_scenes.h"
#include "core/calibration/position_errors.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/calibration_words.h"
#include "reports/words/entry_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

using calibration::CalibratedModel;
using calibration::ReadingError;

std::set<std::size_t> namedPostures(const calibration::Calibration& calibration,
                                    const std::vector<ReadingError>& errors) {
  std::set<std::size_t> named;
  for (const CalibratedModel model : {CalibratedModel::geometry, CalibratedModel::effects}) {
    if (model == CalibratedModel::effects && calibration.best().fit.parts.empty()) continue;
    for (const ReadingError& worst : calibration::worstPostures(errors, model, 1)) named.insert(worst.posture);
  }
  return named;
}

namespace {

/// Postures that are drawn, pale, with what a model leaves at each reflector; those that captions name among them.
render::ArmScene errorScene(const reports::ReportCampaign& one, const std::vector<ReadingError>& errors,
                            CalibratedModel model) {
  const frames::Frames& frames = one.identification.frames;
  const calibration::UnloadedDay& day = one.accuracy->calibration.day;
  const Eigen::Isometry3d& r0_from_base = frames.arm.r0_from_base_link;
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(frames));
  const std::size_t every = (errors.size() + kMostArrows - 1) / kMostArrows;
  const std::set<std::size_t> named = namedPostures(one.accuracy->calibration, errors);
  render::ArmScene scene;
  scene.frame_origin = up;
  std::size_t posture = day.postures.size();
  for (const ReadingError& error : errors) {
    if (error.posture % every != 0 && !named.contains(error.posture)) continue;
    if (!error.of(model).allFinite()) continue;
    if (error.posture != posture) {
      posture = error.posture;
      scene.poses.push_back(bareArm(frames, robot::postureAt(frames.arm.arm, day.postures[posture].q)));
      scene.poses.back().ghost = true;
    }
    scene.poses.back().targets.push_back({"", r0_from_base * error.position + up, std::nullopt, std::nullopt,
                                          Eigen::Vector3d(r0_from_base.linear() * error.of(model))});
  }
  return scene;
}

std::string longestWords(const reports::ReportCampaign& one, CalibratedModel model) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> worst = calibration::worstPostures(calibration::readingErrors(calibration), model, 1);
  const int pose = calibration.day.postures[worst.front().posture].pose;
  return fmt::format("the longest of the day is {}, of {} in posture {}",
                     reports::shownLength(worst.front().of(model).norm(), 2),
                     reports::pointName(calibration.day.targets[static_cast<std::size_t>(worst.front().target)]),
                     reports::asIs(calibration.day.pose_ids[static_cast<std::size_t>(pose)]));
}

}  // namespace

std::optional<GapScenes> accuracyScenes(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  if (errors.empty()) return std::nullopt;
  GapScenes scenes{errorScene(one, errors, CalibratedModel::geometry),
                   errorScene(one, errors, CalibratedModel::effects)};
  if (scenes.before.poses.empty() || scenes.after.poses.empty()) return std::nullopt;
  seeAlike(scenes);
  scenes.before.title = "Left by the calibrated geometry, at the reflectors";
  scenes.after.title = "Left with the effects in the model, to the same scale";
  for (render::ArmScene* scene : {&scenes.before, &scenes.after}) scene->subtitle = reports::asIs(one.campaign.name);
  return scenes;
}

reports::Figure describeAccuracyBefore(const reports::ReportCampaign& one, const GapScenes& scenes) {
  const std::size_t all = one.accuracy->calibration.day.postures.size(), drawn = scenes.before.poses.size();
  reports::Figure figure;
  figure.id = "accuracy-before";
  figure.title = "What the calibrated geometry leaves, on the arm";
  figure.caption = fmt::format(
      "Arrows: measured less model at each reflector, magnified {} times; {}. Arrows that turn with a joint or with "
      "the posture are the machine's; noise would point anywhere.",
      render::factorText(*scenes.before.magnification), longestWords(one, CalibratedModel::geometry));
  if (drawn < all)
    figure.caption += fmt::format(" The picture has {} of {} postures, evenly chosen, and the worst.", drawn, all);
  figure.alt = "Postures of the arm, pale, with an arrow at each reflector for what the calibrated geometry leaves.";
  return figure;
}

reports::Figure describeAccuracyAfter(const reports::ReportCampaign& one, const GapScenes& scenes) {
  std::vector<std::string> names;
  for (const std::string& id : reports::effectIdsOf(one.accuracy->calibration.best().fit))
    names.push_back(reports::nameOfId(id));
  reports::Figure figure;
  figure.id = "accuracy-after";
  figure.title = "What is left with the effects in the model";
  figure.caption = fmt::format(
      "The postures of the first page's figure, to its scale ({} times), with {} in the model; {}. Where long arrows "
      "stay, something else is there.",
      render::factorText(*scenes.after.magnification), fmt::join(names, ", "),
      longestWords(one, CalibratedModel::effects));
  figure.alt = "The same postures of the arm with shorter arrows where the effects explain what was left.";
  return figure;
}

}  // namespace stiffscope::app
