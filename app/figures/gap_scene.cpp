#include "app/figures/gap_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "app/figures/arm_pose.h"
#include "core/input/units.h"
#include "render/ticks.h"
#include "reports/page/effect_words.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr std::size_t kMostArrows = 90;  // more in one picture hide each other

const PointGap* gapOf(const Diagnosis& diagnosis, int pose, int target) {
  const auto found =
      std::find_if(diagnosis.at_points.begin(), diagnosis.at_points.end(),
                   [pose, target](const PointGap& gap) { return gap.pose == pose && gap.target == target; });
  return found == diagnosis.at_points.end() ? nullptr : &*found;
}

/// Of the load cases that the diagnosis looked at (of a long day a hundred) every so many.
std::vector<std::size_t> drawnCases(const ReportCampaign& one) {
  std::set<int> diagnosed;
  for (const PointGap& gap : one.diagnosis->at_points) diagnosed.insert(gap.pose);
  const std::size_t arrows = one.diagnosis->at_points.size(), every = (arrows + kMostArrows - 1) / kMostArrows;
  std::vector<std::size_t> drawn;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
    if (diagnosed.contains(one.identification.cases[i].pose) && seen++ % every == 0) drawn.push_back(i);
  }
  return drawn;
}

/// The postures, pale, with one of the two vectors at each reflector.
ArmScene sceneOf(const ReportCampaign& one, Eigen::Vector3d PointGap::*left) {
  ArmScene scene;
  scene.frame_origin = {0.0, 0.0, heightOfR0(one.identification.frames)};
  for (const std::size_t i : drawnCases(one)) {
    const LoadCase& load_case = one.identification.cases[i];
    ArmPose pose = armPose(one, i, std::nullopt);
    pose.ghost = true;
    pose.wrist.reset();
    std::vector<ScenePoint> shown;
    for (std::size_t t = 0; t < pose.targets.size(); ++t) {
      const PointGap* gap = gapOf(*one.diagnosis, load_case.pose, load_case.targets[t].target);
      if (gap != nullptr)
        shown.push_back({"", pose.targets[t].position, std::nullopt, std::nullopt, gap->*left});
    }
    pose.targets = std::move(shown);
    if (!pose.targets.empty()) scene.poses.push_back(std::move(pose));
  }
  return scene;
}

/// The largest vector, and the posture and reflector that have it.
std::string largestWords(const ReportCampaign& one, Eigen::Vector3d PointGap::*left) {
  const auto largest = std::max_element(
      one.diagnosis->at_points.begin(), one.diagnosis->at_points.end(),
      [left](const PointGap& a, const PointGap& b) { return (a.*left).norm() < (b.*left).norm(); });
  return fmt::format("the longest is {}\u00a0µm, of {} in posture {}",
                     page::significant(((*largest).*left).norm() / kMicrometre, 2),
                     page::pointName(one.campaign.targets[static_cast<std::size_t>(largest->target)].id),
                     page::asIs(one.campaign.pose_ids[static_cast<std::size_t>(largest->pose)]));
}

}  // namespace

std::optional<GapScenes> gapScenes(const ReportCampaign& one) {
  if (one.diagnosis == nullptr || one.diagnosis->verdict.entries.empty() ||
      one.diagnosis->at_points.empty()) {
    return std::nullopt;
  }
  GapScenes scenes{sceneOf(one, &PointGap::before), sceneOf(one, &PointGap::after)};
  if (scenes.before.poses.empty()) return std::nullopt;
  scenes.before.magnification = automaticMagnification(scenes.before);
  scenes.after.magnification = scenes.before.magnification;
  // Both fit both, so that they are seen alike.
  scenes.before.also_fitted = pointsOf(scenes.after, *scenes.after.magnification);
  scenes.after.also_fitted = pointsOf(scenes.before, *scenes.before.magnification);
  scenes.before.title = "Left by joint stiffnesses alone, at the reflectors";
  scenes.after.title = "Left with the verdict's effects in the model, to the same scale";
  scenes.before.subtitle = page::asIs(one.campaign.name);
  scenes.after.subtitle = fmt::format("{}; in the model: {}", page::asIs(one.campaign.name),
                                      page::asIs(page::namedWords(one.diagnosis->verdict)));
  if (!one.diagnosis->as_measured.rows.empty()) scenes.before.subtitle += "; readings as they were";
  for (ArmScene* scene : {&scenes.before, &scenes.after}) scene->residual_name = "measured less model";
  return scenes;
}

Figure describeGapBefore(const ReportCampaign& one, const GapScenes& scenes) {
  Figure figure;
  figure.id = "gap-before";
  figure.title = "What joint stiffnesses alone leave, on the arm";
  figure.caption = fmt::format(
      "Arrows: measured less model at each reflector, in the load state of each posture that leaves the "
      "most, magnified "
      "{} times; {}. Arrows that turn with the posture, alike at all reflectors, are the machine's; noise "
      "would point "
      "anywhere.",
      factorText(*scenes.before.magnification), largestWords(one, &PointGap::before));
  const std::size_t drawn = scenes.before.poses.size(), all = one.identification.cases.size();
  if (drawn < all) {
    figure.caption += fmt::format(" Drawn: {} of {} postures; the longest is of all the diagnosis looked at.", drawn, all);
  }
  figure.alt = "Postures of the arm, pale, with an arrow at each reflector for what the stiffnesses leave.";
  return figure;
}

Figure describeGapAfter(const ReportCampaign& one, const GapScenes& scenes) {
  Figure figure;
  figure.id = "gap-after";
  figure.title = "What is left with the verdict's effects in the model";
  figure.caption = fmt::format(
      "The same as the figure before, to the same scale ({} times), with {} in the model; {}. Where long "
      "arrows stay, "
      "the verdict does not hold.",
      factorText(*scenes.after.magnification), page::asIs(page::namedWords(one.diagnosis->verdict)),
      largestWords(one, &PointGap::after));
  figure.alt = "The same postures of the arm with much shorter arrows where the verdict holds.";
  return figure;
}

}  // namespace stiffscope
