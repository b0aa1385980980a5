#include "app/view/view_material.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>

#include "app/figures/arm_scenes.h"
#include "app/options.h"
#include "core/identification/load_case.h"
#include "core/identification/loaded_arm.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "reports/page/html.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

ViewFrame frameOf(const reports::ReportCampaign& one, std::size_t index, std::optional<identification::Method> method) {
  const identification::LoadCase& load_case = one.identification.cases[index];
  const std::string& posture = one.campaign.pose_ids[static_cast<std::size_t>(load_case.pose)];
  ViewFrame frame;
  frame.scene = postureScene(one, index, method);
  frame.name = fmt::format("posture-{}-step-{}", posture, load_case.step);
  frame.where = fmt::format("posture {}", posture);
  frame.load = fmt::format("load step {}, {}", load_case.step, reports::forceWords(load_case.wrench.force.norm()));
  frame.posture = load_case.pose;
  frame.step = load_case.step;
  frame.force = load_case.wrench.force;
  return frame;
}

}  // namespace

std::vector<ViewMaterial> loadMaterials(const campaign::Campaign& campaign,
                                        const identification::Identification& identified,
                                        const std::vector<identification::Method>& methods,
                                        const std::function<bool(int posture)>& wanted) {
  std::vector<ViewMaterial> materials(std::max<std::size_t>(methods.size(), 1));
  for (ViewMaterial& material : materials) material.campaign = campaign.name;
  for (std::size_t m = 0; m < methods.size(); ++m) materials[m].method = reports::shortName(methods[m]);
  if (methods.empty())
    materials.front().lacking =
        "nothing is predicted: " + reports::words(identified.of(identification::Method::partial_pose).reason);
  for (const int step : identification::loadSteps(campaign)) {
    const identification::Identification other =
        step == identified.step ? identification::Identification{} : underLoadStep(campaign, identified, step);
    const reports::ReportCampaign one{campaign, step == identified.step ? identified : other};
    for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
      if (wanted && !wanted(one.identification.cases[i].pose)) continue;
      for (std::size_t m = 0; m < materials.size(); ++m)
        materials[m].frames.push_back(frameOf(one, i, methods.empty() ? std::nullopt : std::optional(methods[m])));
    }
  }
  return materials;
}

namespace {

identification::Identification identified(const campaign::Campaign& campaign, const ViewOptions& options) {
  identification::IdentifyOptions how;
  how.step = options.step;
  how.subsets.most_all = 0;  // the viewer shows nothing of the subsets
  how.subsets.sample = 1;
  return identification::identify(campaign, how);
}

/// The methods to show, the one to start with first.
std::vector<identification::Method> methodsToShow(const identification::Identification& result,
                                                  const std::string& wanted) {
  std::vector<identification::Method> methods;
  if (!wanted.empty()) {
    const std::vector<identification::Method> named = methodsNamed(wanted);
    if (named.size() == 1 && !result.of(named.front()).available) {
      throw io::InputError({"--method"}, wanted,
                           "not available here: " + reports::words(result.of(named.front()).reason));
    }
    if (named.size() == 1) methods.push_back(named.front());
  }
  const auto shown = reports::shownMethod(result);
  if (shown && methods.empty()) methods.push_back(*shown);
  for (const identification::Method method :
       {identification::Method::decoupled_partial_pose, identification::Method::partial_pose,
        identification::Method::complete_pose}) {
    if (result.of(method).available && std::find(methods.begin(), methods.end(), method) == methods.end()) {
      methods.push_back(method);
    }
  }
  return methods;
}

int postureNamed(const campaign::Campaign& campaign, const std::string& id) {
  const auto found = std::find(campaign.pose_ids.begin(), campaign.pose_ids.end(), id);
  if (found == campaign.pose_ids.end()) {
    throw io::InputError({"--pose"}, id, "not a posture of this campaign" + io::nearestNameHint(id, campaign.pose_ids));
  }
  return static_cast<int>(found - campaign.pose_ids.begin());
}

/// Of the frames of `step`, or of any where that has none, the one with this posture.
std::size_t frameToStart(const ViewMaterial& material, int step, int posture) {
  const auto at = [&](const auto& fits) {
    return static_cast<std::size_t>(std::find_if(material.frames.begin(), material.frames.end(), fits) -
                                    material.frames.begin());
  };
  std::size_t found = at([&](const ViewFrame& one) { return one.step == step && one.posture == posture; });
  if (found == material.frames.size()) found = at([&](const ViewFrame& one) { return one.posture == posture; });
  return found;
}

OpenedMaterial openLoads(const campaign::Campaign& campaign, const identification::Identification& result,
                         const ViewOptions& options) {
  OpenedMaterial opened{loadMaterials(campaign, result, methodsToShow(result, options.method))};
  const ViewMaterial& material = opened.by_method.front();
  if (material.frames.empty()) return {};
  if (!options.pose.empty()) {
    opened.first = frameToStart(material, result.step, postureNamed(campaign, options.pose));
    if (opened.first == material.frames.size()) {
      throw io::InputError({"--pose"}, options.pose, "this posture has no readings under load");
    }
  } else if (!result.cases.empty()) {
    opened.first = frameToStart(material, result.step, result.cases[medianCase({campaign, result})].pose);
  }
  return opened;
}

OpenedMaterial openSweeps(const campaign::Campaign& campaign, const ViewOptions& options, const std::string& why) {
  if (!options.method.empty() || options.step || !options.pose.empty()) {
    throw io::InputError({campaign.folder / "campaign.xml"}, "",
                         "no loads to show, so no method, step or posture: " + why);
  }
  ViewMaterial sweeps = sweepMaterial(campaign, frames::measureFrames(campaign));
  if (sweeps.frames.empty()) {
    throw io::InputError({campaign.folder / "campaign.xml"}, "", "nothing to show: " + why + "; " + sweeps.lacking);
  }
  return {{std::move(sweeps)}, 0};
}

}  // namespace

OpenedMaterial openMaterial(const campaign::Campaign& campaign, const ViewOptions& options) {
  const Remark lacking = identification::whatLoadsLack(campaign);
  if (!lacking.empty()) return openSweeps(campaign, options, reports::words(lacking));
  if (!identification::heaviestStep(campaign)) return openSweeps(campaign, options, "no load step has a force");
  const identification::Identification result = identified(campaign, options);
  OpenedMaterial opened = openLoads(campaign, result, options);
  if (!opened.by_method.empty()) return opened;
  return openSweeps(campaign, options, reports::words(result.of(identification::Method::partial_pose).reason));
}

namespace {

/// The readings of one axis and one reflector, in the scene.
struct Circle {
  int axis = 0;
  int target = 0;
  std::vector<const campaign::CircleReading*> readings;
};

std::vector<Circle> circlesOf(const campaign::CircleSweeps& sweeps) {
  std::vector<Circle> circles;
  for (const campaign::CircleReading& reading : sweeps.rows) {
    auto found = std::find_if(circles.begin(), circles.end(), [&](const Circle& circle) {
      return circle.axis == reading.axis && circle.target == reading.target;
    });
    if (found == circles.end()) found = circles.insert(found, {reading.axis, reading.target, {}});
    found->readings.push_back(&reading);
  }
  return circles;
}

std::vector<render::SceneTrace> tracesOf(const campaign::Campaign& campaign, const std::vector<Circle>& circles,
                                         int axis, const Eigen::Isometry3d& scene_from_points) {
  std::vector<render::SceneTrace> traces;
  for (const Circle& circle : circles) {
    render::SceneTrace trace;
    trace.label = reports::pointName(campaign.targets[static_cast<std::size_t>(circle.target)].id);
    trace.faint = circle.axis != axis;
    for (const campaign::CircleReading* reading : circle.readings)
      trace.points.push_back(scene_from_points * reading->point);
    traces.push_back(std::move(trace));
  }
  return traces;
}

std::string axisWords(const frames::MeasuredAxis& axis) {
  if (!axis.measured) return "not measured: " + reports::words(axis.reason);
  double arc = 0.0;
  for (const metrology::AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
  return fmt::format("arc {}\u00b0, circles fitted to {}\u00a0\u00b5m rms", reports::fixed(arc / io::kDegree, 0),
                     reports::significant(1e6 * axis.fit.rms, 2));
}

}  // namespace

ViewMaterial sweepMaterial(const campaign::Campaign& campaign, const frames::Frames& frames) {
  ViewMaterial material;
  material.campaign = campaign.name;
  if (!campaign.circle_sweeps) {
    material.lacking = "the campaign has neither loads nor circle sweeps to show";
    return material;
  }
  const auto r0_from_points = frames::r0FromTable(frames, campaign.circle_sweeps->frame);
  if (!r0_from_points) {
    material.lacking =
        "the sweeps do not place R0 (axes 1 and 2 must be measured), so their readings cannot be shown on "
        "the arm";
    return material;
  }
  const Eigen::Isometry3d scene_from_points = Eigen::Translation3d(0.0, 0.0, heightOfR0(frames)) * *r0_from_points;
  const std::vector<Circle> circles = circlesOf(*campaign.circle_sweeps);
  for (int axis = 0; axis < static_cast<int>(frames.axes.size()); ++axis) {
    const auto of_axis =
        std::find_if(circles.begin(), circles.end(), [&](const Circle& circle) { return circle.axis == axis; });
    if (of_axis == circles.end()) continue;
    const campaign::CircleReading& middle = *of_axis->readings[of_axis->readings.size() / 2];
    ViewFrame frame;
    frame.scene.title = fmt::format("Circle sweep of axis {}", axis + 1);
    frame.scene.subtitle =
        fmt::format("{}; {}", reports::asIs(campaign.name), axisWords(frames.axes[static_cast<std::size_t>(axis)]));
    frame.scene.poses = {bareArm(frames, robot::postureAt(frames.arm.arm, middle.q))};
    frame.scene.traces = tracesOf(campaign, circles, axis, scene_from_points);
    frame.scene.trace_name = "tracker readings of this sweep, the others pale";
    frame.scene.frame_origin = {0.0, 0.0, heightOfR0(frames)};
    frame.name = fmt::format("axis-{}", axis + 1);
    frame.where = fmt::format("axis {}", axis + 1);
    frame.posture = axis;
    material.frames.push_back(std::move(frame));
  }
  return material;
}

namespace {

/// The geometry in which the cases of `identified` are shown: the swept one, or Partial Pose's calibrated one
/// where no sweeps place the readings.
frames::LoadingGeometry shownGeometry(const campaign::Campaign& campaign,
                                      const identification::Identification& identified) {
  for (const identification::Method method :
       {identification::Method::decoupled_partial_pose, identification::Method::complete_pose}) {
    if (identified.of(method).available) return identified.of(method).geometry;
  }
  const identification::MethodResult& partial = identified.of(identification::Method::partial_pose);
  const JointVector sag = partial.available ? JointVector(partial.estimate.compliance.cwiseMax(0.0))
                                            : JointVector(JointVector::Zero(campaign.robot.joints()));
  frames::LoadingGeometry swept = frames::sweptGeometry(campaign, identified.frames, sag);
  if (partial.available && identification::loadCases(campaign, swept, identified.step).empty()) return partial.geometry;
  return swept;
}

/// `rows` of `from`'s cases in the order of `to`'s, by posture.
std::vector<identification::CaseEquations> alignedRows(const std::vector<identification::CaseEquations>& rows,
                                                       const std::vector<identification::LoadCase>& from,
                                                       const std::vector<identification::LoadCase>& to) {
  std::map<int, std::size_t> row_of;
  for (std::size_t i = 0; i < rows.size(); ++i) row_of[from[i].pose] = i;
  std::vector<identification::CaseEquations> aligned;
  for (const identification::LoadCase& wanted : to) {
    const auto found = row_of.find(wanted.pose);
    aligned.push_back(found == row_of.end() ? identification::CaseEquations() : rows[found->second]);
  }
  return aligned;
}

}  // namespace

identification::Identification underLoadStep(const campaign::Campaign& campaign,
                                             const identification::Identification& identified, int step) {
  identification::Identification other(campaign.robot.joints());
  other.step = step;
  other.steps = {step};
  other.frames = identified.frames;
  other.finite_deflection = identified.finite_deflection;
  const identification::LoadedArm shown = identification::loadedArm(campaign, shownGeometry(campaign, identified),
                                                                    identified.frames.wrist, {step}, &other.left_out);
  other.cases = shown.cases;
  other.wrist = shown.wrist;
  for (const identification::Method which : identification::kMethods) {
    const identification::MethodResult& known = identified.of(which);
    if (!known.available) continue;
    identification::LoadedArm arm =
        identification::loadedArm(campaign, known.geometry, identified.frames.wrist, {step});
    // Nothing is solved: the known estimate stands in for every round's.
    identification::solveLoadedArm(arm, identified.finite_deflection,
                                   [&](const identification::LoadedArm&) { return known.estimate.compliance; });
    identification::MethodResult& out = other.methods[static_cast<std::size_t>(which)];
    out.available = true;
    out.estimate = known.estimate;
    out.geometry = known.geometry;
    out.target_rows = alignedRows(identification::reflectorEquations(arm), arm.cases, shown.cases);
    if (!arm.wrist.empty())
      out.wrist_rows = alignedRows(identification::wristPointEquations(arm), arm.cases, shown.cases);
  }
  return other;
}

}  // namespace stiffscope::app
