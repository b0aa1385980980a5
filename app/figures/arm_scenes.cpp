#include "app/figures/arm_scenes.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/comparison/matched_postures.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "metrology/lines.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

namespace {

/// A point on each axis, all joints at zero: a chain that looks like the arm for any place of the axes' own
/// points.
PerJoint<Eigen::Vector3d> jointPointsAtZero(const robot::Robot& arm, const Eigen::Vector3d& foot) {
  PerJoint<Eigen::Vector3d> points;
  for (const metrology::Line& axis : arm.axes_in_base_at_zero)
    points.push_back(metrology::nearestPoint(axis, points.empty() ? foot : points.back()));
  return points;
}

/// The three rows of a point out of A c; empty where the method does not have them.
std::optional<Eigen::Vector3d> predicted(const std::vector<identification::CaseEquations>& rows, std::size_t index,
                                         std::size_t point, const JointVector& compliance) {
  if (index >= rows.size()) return std::nullopt;
  const auto row = static_cast<Eigen::Index>(3 * point);
  if (row + 3 > rows[index].matrix.rows()) return std::nullopt;
  return Eigen::Vector3d(rows[index].matrix.middleRows<3>(row) * compliance);
}

}  // namespace

double heightOfR0(const frames::Frames& frames) {
  return std::max(0.0, -frames.arm.r0_from_base_link.translation().z());
}

render::ArmPose bareArm(const frames::Frames& frames, const robot::ArmPosture& posture) {
  const robot::Robot& arm = frames.arm.arm;
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(frames));  // from R0's origin to the scene's
  render::ArmPose pose;
  const PerJoint<Eigen::Vector3d> points = jointPointsAtZero(arm, -up);
  for (int axis = 0; axis < arm.axes(); ++axis) {
    const auto j = static_cast<std::size_t>(axis);
    pose.joint_points.push_back(posture.motion[j] * points[j] + up);
    pose.axis_directions.push_back(robot::axisAt(arm, posture, axis).direction);
  }
  pose.joint_points.push_back(robot::flangeAt(arm, posture).translation() + up);
  return pose;
}

render::ArmPose armPose(const reports::ReportCampaign& one, std::size_t index,
                        std::optional<identification::Method> which) {
  const identification::Identification& result = one.identification;
  const identification::LoadCase& load_case = result.cases[index];
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(result.frames));
  const identification::MethodResult* method = which && result.of(*which).available ? &result.of(*which) : nullptr;
  const auto pointOf = [&](std::string label, const Eigen::Vector3d& unloaded, const Eigen::Vector3d& displacement,
                           const auto& rows, std::size_t at) {
    render::ScenePoint point{std::move(label), unloaded + up, displacement, std::nullopt, std::nullopt};
    if (method) point.predicted = predicted(method->*rows, index, at, method->estimate.compliance);
    if (point.predicted) point.residual = displacement - *point.predicted;
    return point;
  };

  render::ArmPose pose = bareArm(result.frames, identification::unloadedPosture(result.frames.arm.arm, load_case));
  for (std::size_t t = 0; t < load_case.targets.size(); ++t) {
    const identification::TargetMove& move = load_case.targets[t];
    pose.targets.push_back(pointOf(reports::pointName(one.campaign.targets[static_cast<std::size_t>(move.target)].id),
                                   move.unloaded, move.displacement(), &identification::MethodResult::target_rows, t));
  }
  pose.load = render::SceneLoad{load_case.wrench.point + up, load_case.wrench.force, "load"};
  if (index < result.wrist.size()) {
    const identification::WristMove& move = result.wrist[index];
    pose.wrist = pointOf("P_{wrist}", move.unloaded, move.displacement(), &identification::MethodResult::wrist_rows, 0);
  }
  return pose;
}

namespace {

void nameVectors(render::ArmScene& scene, std::optional<identification::Method> method) {
  if (!method) return;
  scene.predicted_name = fmt::format("predicted by {}", reports::shortName(*method));
  scene.residual_name = fmt::format("residual of {}", reports::shortName(*method));
}

/// R0 in the scene, whose floor is at the foot of axis 1.
Eigen::Vector3d placeOfR0(const reports::ReportCampaign& one) {
  return {0.0, 0.0, heightOfR0(one.identification.frames)};
}

std::string framesWords(const reports::ReportCampaign& one) {
  return fmt::format("The axes drawn are R_{{0}}, {} mm above base_link.",
                     reports::fixed(reports::kMmPerM * heightOfR0(one.identification.frames), 0));
}

/// "The same load moves", or the range of loads where they differ by more than a fiftieth.
std::string loadWords(const identification::Identification& identification) {
  std::vector<double> forces;
  for (const identification::LoadCase& load_case : identification.cases)
    forces.push_back(load_case.wrench.force.norm());
  const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
  if (*most <= 1.02 * *least) return "The same load moves";
  return fmt::format("Loads of {} to {} move", reports::forceWords(*least), reports::forceWords(*most));
}

/// The point whose vectors the scene of all postures shows.
std::string vectorPoint(const reports::ReportCampaign& one) {
  if (reports::judgedPoint(one).at_wrist) return "P_{wrist}";
  return reports::pointName(one.campaign.targets.front().id);
}

}  // namespace

std::size_t medianCase(const reports::ReportCampaign& one) {
  const auto& values = reports::displacementAt(one.identification, reports::judgedPoint(one).at_wrist);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>((order.size() - 1) / 2);
  std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  return *middle;
}

render::ArmScene postureScene(const reports::ReportCampaign& one, std::size_t index,
                              std::optional<identification::Method> method) {
  const double force = one.identification.cases[index].wrench.force.norm();
  render::ArmScene scene;
  scene.title =
      fmt::format("Deflection in posture {} under {}", reports::postureName(one, index), reports::forceWords(force));
  scene.subtitle = reports::asIs(one.campaign.name);
  scene.poses = {armPose(one, index, method)};
  nameVectors(scene, method);
  scene.residual_factor = render::automaticResidualFactor(scene);
  scene.frame_origin = placeOfR0(one);
  return scene;
}

namespace {

/// None: the oblique view. Where load and deflection would run along it, it is turned about the vertical until they are
/// seen from the side, to the hand where the arm's `reach` (from its foot to the flange) is seen longer.
std::optional<Eigen::Vector3d> viewAcross(const Eigen::Vector3d& force, const Eigen::Vector3d& reach) {
  constexpr double kNearlyAlong = 0.9, kTurn = M_PI / 3.0;
  const Eigen::Vector3d oblique = render::directionOf(render::View::oblique);
  if (std::abs(oblique.dot(force.normalized())) < kNearlyAlong) return std::nullopt;
  const auto turned = [&oblique](double angle) {
    return Eigen::Vector3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * oblique);
  };
  const auto seen = [&reach](const Eigen::Vector3d& view) {
    return std::abs(view.cross(Eigen::Vector3d::UnitZ()).normalized().dot(reach));
  };
  const Eigen::Vector3d one = turned(kTurn), other = turned(-kTurn);
  return seen(one) > seen(other) ? one : other;
}

}  // namespace

namespace {

render::ArmScene deflectionScene(const reports::ReportCampaign& one, std::size_t load_case) {
  render::ArmScene scene = postureScene(one, load_case, reports::shownMethod(one.identification));
  const auto& joints = scene.poses.front().joint_points;
  scene.view_direction = viewAcross(one.identification.cases[load_case].wrench.force, joints.back() - joints.front());
  return scene;
}

/// To the least magnification of all, from where the first is seen; each fits what the others show.
void seeAlike(std::vector<DeflectionScene*>& scenes) {
  double magnification = std::numeric_limits<double>::infinity(), residual_factor = magnification;
  for (const DeflectionScene* one : scenes) residual_factor = std::min(residual_factor, one->scene.residual_factor);
  for (DeflectionScene* one : scenes) {
    one->scene.residual_factor = residual_factor;
    magnification = std::min(magnification, render::automaticMagnification(one->scene));
  }
  for (DeflectionScene* one : scenes) {
    one->scene.magnification = magnification;
    one->scene.view_direction = scenes.front()->scene.view_direction;
    for (const DeflectionScene* other : scenes) {
      if (other == one) continue;
      const auto points = render::pointsOf(other->scene, magnification);
      one->scene.also_fitted.insert(one->scene.also_fitted.end(), points.begin(), points.end());
    }
  }
}

/// The load case of `other` that is case `index` of `one`; none where it lacks that.
std::optional<std::size_t> sameCase(const reports::ReportCampaign& one, std::size_t index,
                                    const reports::ReportCampaign& other) {
  const comparison::MatchedPostures matched =
      comparison::matchPostures(one.campaign, one.identification, other.campaign, other.identification);
  for (const comparison::PosturePair& pair : matched.pairs) {
    if (pair.before == index) return pair.after;
  }
  return std::nullopt;
}

}  // namespace

render::ArmScene deflectionScene(const reports::ReportCampaign& one) { return deflectionScene(one, medianCase(one)); }

std::vector<std::optional<DeflectionScene>> deflectionScenes(const std::vector<reports::ReportCampaign>& campaigns) {
  std::vector<std::optional<DeflectionScene>> scenes(campaigns.size());
  std::vector<std::size_t> loaded;
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    if (!campaigns[i].identification.cases.empty()) loaded.push_back(i);
  }
  std::vector<std::size_t> of_first;  // the case of each loaded campaign in the posture of the first
  for (const std::size_t i : loaded) {
    const reports::ReportCampaign& first = campaigns[loaded.front()];
    const auto same = i == loaded.front() ? medianCase(first) : sameCase(first, medianCase(first), campaigns[i]);
    if (same) of_first.push_back(*same);
  }
  const bool alike = of_first.size() == loaded.size();
  std::vector<DeflectionScene*> drawn;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const reports::ReportCampaign& one = campaigns[loaded[k]];
    const std::size_t load_case = alike ? of_first[k] : medianCase(one);
    DeflectionScene& made = scenes[loaded[k]].emplace();
    made.load_case = load_case;
    made.scene = deflectionScene(one, load_case);
    made.scene.magnification = render::automaticMagnification(made.scene);
    if (alike && k > 0) made.as_in = campaigns[loaded.front()].campaign.name;
    drawn.push_back(&made);
  }
  if (alike && drawn.size() > 1) {
    for (DeflectionScene* one : drawn) one->scene.magnification.reset();
    seeAlike(drawn);
  }
  return scenes;
}

render::ArmScene allPosturesScene(const reports::ReportCampaign& one) {
  render::ArmScene scene;
  scene.title = fmt::format("Deflection of {} in all {} postures", vectorPoint(one), one.identification.cases.size());
  scene.subtitle = reports::asIs(one.campaign.name);
  const auto method = reports::shownMethod(one.identification);
  nameVectors(scene, method);
  scene.frame_origin = placeOfR0(one);
  for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
    render::ArmPose pose = armPose(one, i, method);
    pose.ghost = true;
    const std::string shown = vectorPoint(one);  // P_wrist is not among the targets: none of them stays
    std::erase_if(pose.targets, [&](const render::ScenePoint& target) { return target.label != shown; });
    // What is left is too small beside so many arrows.
    for (render::ScenePoint& target : pose.targets) target.residual.reset();
    if (pose.wrist) pose.wrist->residual.reset();
    scene.poses.push_back(std::move(pose));
  }
  return scene;
}

reports::Figure describeDeflectionScene(const reports::ReportCampaign& one, const DeflectionScene& drawn) {
  const std::size_t index = drawn.load_case;
  const double magnification = drawn.scene.magnification.value_or(1.0);
  const reports::JudgedPoint point = reports::judgedPoint(one);
  const double displacement = reports::kMmPerM * reports::displacementAt(one.identification, point.at_wrist)[index];
  reports::Figure figure;
  figure.id = "deflection";
  figure.title = fmt::format("Deflection in posture {}", reports::postureName(one, index));
  const std::string factor = render::factorText(magnification), moved = reports::fixed(displacement, 2);
  figure.caption =
      drawn.as_in.empty()
          ? fmt::format("The posture with the median displacement of {}, {}\u00a0mm, magnified {} times.", point.name,
                        moved, factor)
          : fmt::format("The same posture, view and scale as of {}: {} moves by {}\u00a0mm, magnified {} times.",
                        reports::asIs(drawn.as_in), point.name, moved, factor);
  if (const auto shown = reports::shownMethod(one.identification)) {
    const double left = reports::kMmPerM * reports::residualAt(one.identification.of(*shown), point.at_wrist)[index];
    figure.caption += fmt::format(" Where the arrows part is what {} leaves: {}\u00a0mm at {}",
                                  reports::shortName(*shown), reports::significant(left, 2), point.name);
    const double longer = drawn.scene.residual_factor;
    figure.caption +=
        longer > 1 ? fmt::format(", drawn {} times longer than the others.", reports::fixed(longer, 0)) : ".";
  }
  figure.caption += fmt::format(" {}", framesWords(one));
  figure.alt = fmt::format(
      "The arm in posture {} with arrows for the measured, predicted and residual displacement of its reflectors{}, "
      "magnified {} times.",
      reports::plain(reports::postureName(one, index)), point.at_wrist ? " and wrist centre" : "",
      render::factorText(magnification));
  return figure;
}

reports::Figure describeAllPostures(const reports::ReportCampaign& one, double magnification) {
  const reports::JudgedPoint point = reports::judgedPoint(one);
  const auto& values = reports::displacementAt(one.identification, point.at_wrist);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  reports::Figure figure;
  figure.id = "all-postures";
  figure.title = fmt::format("Deflection of {} in all postures", vectorPoint(one));
  figure.caption = fmt::format(
      "{} {} by {} to {}\u00a0mm, depending on the posture; vectors magnified {} "
      "times. {}",
      loadWords(one.identification), point.name, reports::fixed(reports::kMmPerM * *least, 2),
      reports::fixed(reports::kMmPerM * *most, 2), render::factorText(magnification), framesWords(one));
  figure.alt = fmt::format("All {} postures of the arm, pale, with an arrow for the displacement of {} in each.",
                           values.size(), reports::plain(vectorPoint(one)));
  return figure;
}

namespace {

const diagnosis::PointGap* gapOf(const diagnosis::Diagnosis& diagnosis, int pose, int target) {
  const auto found =
      std::find_if(diagnosis.at_points.begin(), diagnosis.at_points.end(),
                   [pose, target](const diagnosis::PointGap& gap) { return gap.pose == pose && gap.target == target; });
  return found == diagnosis.at_points.end() ? nullptr : &*found;
}

}  // namespace

const diagnosis::PointGap& longestGap(const diagnosis::Diagnosis& diagnosis, GapVector left) {
  return *std::max_element(diagnosis.at_points.begin(), diagnosis.at_points.end(),
                           [left](const diagnosis::PointGap& a, const diagnosis::PointGap& b) {
                             return (a.*left).norm() < (b.*left).norm();
                           });
}

namespace {

/// Of the load cases that the diagnosis looked at (of a long day a hundred) every so many, and those that captions
/// name.
std::vector<std::size_t> drawnCases(const reports::ReportCampaign& one) {
  std::set<int> diagnosed;
  for (const diagnosis::PointGap& gap : one.diagnosis->at_points) diagnosed.insert(gap.pose);
  const std::size_t arrows = one.diagnosis->at_points.size(), every = (arrows + kMostArrows - 1) / kMostArrows;
  const std::set<int> named{longestGap(*one.diagnosis, &diagnosis::PointGap::before).pose,
                            longestGap(*one.diagnosis, &diagnosis::PointGap::after).pose};
  std::vector<std::size_t> drawn;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
    const int pose = one.identification.cases[i].pose;
    if (diagnosed.contains(pose) && (seen++ % every == 0 || named.contains(pose))) drawn.push_back(i);
  }
  return drawn;
}

/// The postures, pale, with one of the two vectors at each reflector.
render::ArmScene sceneOf(const reports::ReportCampaign& one, GapVector left) {
  render::ArmScene scene;
  scene.frame_origin = {0.0, 0.0, heightOfR0(one.identification.frames)};
  for (const std::size_t i : drawnCases(one)) {
    const identification::LoadCase& load_case = one.identification.cases[i];
    render::ArmPose pose = armPose(one, i, std::nullopt);
    pose.ghost = true;
    pose.wrist.reset();
    std::vector<render::ScenePoint> shown;
    for (std::size_t t = 0; t < pose.targets.size(); ++t) {
      const diagnosis::PointGap* gap = gapOf(*one.diagnosis, load_case.pose, load_case.targets[t].target);
      if (gap != nullptr) shown.push_back({"", pose.targets[t].position, std::nullopt, std::nullopt, gap->*left});
    }
    pose.targets = std::move(shown);
    if (!pose.targets.empty()) scene.poses.push_back(std::move(pose));
  }
  return scene;
}

/// The largest vector, and the posture and reflector that have it.
std::string largestWords(const reports::ReportCampaign& one, GapVector left) {
  const diagnosis::PointGap& largest = longestGap(*one.diagnosis, left);
  return fmt::format("the longest is {}, of {} in posture {}", reports::shownLength((largest.*left).norm(), 2),
                     reports::pointName(one.campaign.targets[static_cast<std::size_t>(largest.target)].id),
                     reports::asIs(one.campaign.pose_ids[static_cast<std::size_t>(largest.pose)]));
}

}  // namespace

void seeAlike(GapScenes& scenes) {
  scenes.before.magnification = render::automaticMagnification(scenes.before);
  scenes.after.magnification = scenes.before.magnification;
  scenes.before.also_fitted = render::pointsOf(scenes.after, *scenes.after.magnification);
  scenes.after.also_fitted = render::pointsOf(scenes.before, *scenes.before.magnification);
  for (render::ArmScene* scene : {&scenes.before, &scenes.after}) scene->residual_name = "measured less model";
}

std::optional<GapScenes> gapScenes(const reports::ReportCampaign& one) {
  if (one.diagnosis == nullptr || one.diagnosis->verdict.entries.empty() || one.diagnosis->at_points.empty()) {
    return std::nullopt;
  }
  GapScenes scenes{sceneOf(one, &diagnosis::PointGap::before), sceneOf(one, &diagnosis::PointGap::after)};
  if (scenes.before.poses.empty()) return std::nullopt;
  seeAlike(scenes);
  scenes.before.title = "Left by joint stiffnesses alone, at the reflectors";
  scenes.after.title = "Left with the verdict's effects in the model, to the same scale";
  scenes.before.subtitle = reports::asIs(one.campaign.name);
  scenes.after.subtitle = fmt::format("{}; in the model: {}", reports::asIs(one.campaign.name),
                                      reports::asIs(reports::namedWords(one.diagnosis->verdict)));
  if (!one.diagnosis->as_measured.rows.empty()) scenes.before.subtitle += "; readings as they were";
  return scenes;
}

reports::Figure describeGapBefore(const reports::ReportCampaign& one, const GapScenes& scenes) {
  reports::Figure figure;
  figure.id = "gap-before";
  figure.title = "What joint stiffnesses alone leave, on the arm";
  figure.caption = fmt::format(
      "Arrows: measured less model at each reflector, in the load state of each posture that leaves the most, "
      "magnified {} times; {}. Arrows that turn with the posture, alike at all reflectors, are the machine's; noise "
      "would point anywhere.",
      render::factorText(*scenes.before.magnification), largestWords(one, &diagnosis::PointGap::before));
  const std::size_t drawn = scenes.before.poses.size(), all = one.identification.cases.size();
  if (drawn < all) {
    figure.caption +=
        fmt::format(" The picture has {} of {} postures; the longest is of all the diagnosis looked at.", drawn, all);
  }
  figure.alt = "Postures of the arm, pale, with an arrow at each reflector for what the stiffnesses leave.";
  return figure;
}

reports::Figure describeGapAfter(const reports::ReportCampaign& one, const GapScenes& scenes) {
  reports::Figure figure;
  figure.id = "gap-after";
  figure.title = "What is left with the verdict's effects in the model";
  figure.caption = fmt::format(
      "The same as the figure before, to the same scale ({} times), with {} in the model; {}. Where long arrows stay, "
      "the verdict does not hold.",
      render::factorText(*scenes.after.magnification), reports::asIs(reports::namedWords(one.diagnosis->verdict)),
      largestWords(one, &diagnosis::PointGap::after));
  figure.alt = "The same postures of the arm with much shorter arrows where the verdict holds.";
  return figure;
}

}  // namespace stiffscope::app
