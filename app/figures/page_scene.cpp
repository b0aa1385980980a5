#include "app/figures/page_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/figures/arm_scenes.h"
#include "app/view/view_material.h"
#include "core/calibration/position_errors.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "render/colours.h"
#include "reports/json/json_document.h"
#include "reports/page/html.h"
#include "reports/words/names.h"

namespace stiffscope::app {

namespace {

using reports::Json;

/// To a hundredth of the unit, which is finer than anything that can be seen.
Json vectorJson(const Eigen::Vector3d& v, double unit) {
  const auto number = [unit](double x) { return std::round(100.0 * x / unit) / 100.0 + 0.0; };
  return Json::array({number(v.x()), number(v.y()), number(v.z())});
}

Json placeJson(const Eigen::Vector3d& point) { return vectorJson(point, io::kMillimetre); }
Json moveJson(const Eigen::Vector3d& move) { return vectorJson(move, io::kMicrometre); }

Json paletteJson(const render::Palette& palette, const render::Colour& effects) {
  const auto colour = [](const render::Colour& c) { return Json::array({c.red, c.green, c.blue}); };
  return {{"paper", colour(palette.paper)},
          {"ink", colour(palette.ink)},
          {"grid", colour(palette.grid)},
          {"measured", colour(palette.measured)},
          {"predicted", colour(palette.predicted)},
          {"residual", colour(palette.residual)},
          {"effects", colour(effects)},
          {"target", colour(palette.target)},
          {"wrist", colour(palette.wrist)},
          {"link", colour(palette.link)},
          {"joint", colour(palette.joint)}};
}

Json vectorKind(const char* key, const std::string& name, const char* colour, double width, double head = 15) {
  return {{"key", key}, {"name", name}, {"colour", colour}, {"width", width}, {"head", head}};
}

/// Bytes of names that are not UTF-8 become U+FFFD.
std::string sceneText(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// What all scenes have.
Json emptyScene(const reports::ReportCampaign& one) {
  constexpr render::Colour kEffects = render::colours::kWrist;  // of the palettes' colours the one that no vector has
  Json json = Json::object();
  json["campaign"] = one.campaign.name;
  json["origin"] = placeJson({0.0, 0.0, heightOfR0(one.identification.frames)});
  json["palette"] = {{"light", paletteJson(render::kLightPalette, kEffects)},
                     {"dark", paletteJson(render::kDarkPalette, kEffects)}};
  json["corrected"] = false;
  json["magnification"] = 1.0;
  json["residual_factor"] = 1.0;
  json["first"] = 0;
  json["methods"] = Json::array();
  json["vectors"] = Json::array();
  json["frames"] = Json::array();
  return json;
}

Json frameJson(const std::string& id, const std::string& where, const std::string& load, int posture, int step,
               const render::ArmPose& arm) {
  Json joints = Json::array(), axes = Json::array();
  for (const Eigen::Vector3d& point : arm.joint_points) joints.push_back(placeJson(point));
  for (const Eigen::Vector3d& axis : arm.axis_directions) axes.push_back(vectorJson(axis, 0.01));
  return {{"id", id},     {"where", where},   {"load", load}, {"posture", posture},
          {"step", step}, {"joints", joints}, {"axes", axes}, {"points", Json::array()}};
}

/// Which postures of a long day are shown.
bool isShown(int posture, std::size_t postures) {
  const std::size_t every = (postures + kMostScenePostures - 1) / kMostScenePostures;
  return static_cast<std::size_t>(posture) % std::max<std::size_t>(every, 1) == 0;
}

/// The frame of `material` in the same posture and step; null where there is none.
const ViewFrame* sameState(const ViewMaterial& material, const ViewFrame& frame, std::size_t hint) {
  const auto same = [&frame](const ViewFrame& one) { return one.posture == frame.posture && one.step == frame.step; };
  if (hint < material.frames.size() && same(material.frames[hint])) return &material.frames[hint];
  const auto found = std::find_if(material.frames.begin(), material.frames.end(), same);
  return found == material.frames.end() ? nullptr : &*found;
}

std::vector<const render::ScenePoint*> pointsOf(const render::ArmPose& pose) {
  std::vector<const render::ScenePoint*> points;
  for (const render::ScenePoint& target : pose.targets) points.push_back(&target);
  if (pose.wrist) points.push_back(&*pose.wrist);
  return points;
}

const render::ScenePoint* pointNamed(const render::ArmPose& pose, const std::string& label) {
  for (const render::ScenePoint* point : pointsOf(pose)) {
    if (point->label == label) return point;
  }
  return nullptr;
}

/// One method's material and its name.
struct NamedMaterial {
  identification::Method method{};
  const ViewMaterial& material;
};

Json loadedPoints(const ViewFrame& frame, std::size_t index, const std::vector<NamedMaterial>& methods,
                  const ViewMaterial* before_correction) {
  const render::ArmPose& pose = frame.scene.poses.front();
  const ViewFrame* before = before_correction != nullptr ? sameState(*before_correction, frame, index) : nullptr;
  Json points = Json::array();
  for (const render::ScenePoint* point : pointsOf(pose)) {
    Json json{{"label", point->label}, {"at", placeJson(point->position)}};
    if (pose.wrist && point == &*pose.wrist) json["wrist"] = true;
    if (point->measured) json["m"] = moveJson(*point->measured);
    for (const NamedMaterial& one : methods) {
      const ViewFrame* by = sameState(one.material, frame, index);
      const render::ScenePoint* same = by != nullptr ? pointNamed(by->scene.poses.front(), point->label) : nullptr;
      if (same != nullptr && same->predicted) json["p"][reports::namesOf(one.method).key] = moveJson(*same->predicted);
    }
    const render::ScenePoint* as_read =
        before != nullptr ? pointNamed(before->scene.poses.front(), point->label) : nullptr;
    // P_wrist is found by the geometry, which correcting changes too: there is no such difference of one point.
    const bool is_wrist = json.contains("wrist");
    if (!is_wrist && as_read != nullptr && as_read->measured && point->measured)
      json["e"] = moveJson(*as_read->measured - *point->measured);
    points.push_back(std::move(json));
  }
  return points;
}

/// Those that can be shown, the one that the report shows first.
std::vector<identification::Method> methodsOf(const identification::Identification& result) {
  const auto shown = reports::shownMethod(result);
  std::vector<identification::Method> methods;
  if (shown) methods.push_back(*shown);
  for (const identification::Method method : identification::kMethods) {
    if (method != shown && result.of(method).available) methods.push_back(method);
  }
  return methods;
}

}  // namespace

std::set<int> namedPoses(const reports::ReportCampaign& one) {
  const identification::Identification& result = one.identification;
  std::set<int> named;
  const auto addLongest = [&](const std::vector<double>& lengths) {
    const auto longest = std::max_element(lengths.begin(), lengths.end());
    const auto at = static_cast<std::size_t>(longest - lengths.begin());
    if (at < result.cases.size()) named.insert(result.cases[at].pose);
  };
  addLongest(reports::displacementAt(result, reports::judgedPoint(one).at_wrist));
  if (const auto shown = reports::shownMethod(result)) {
    const identification::MethodResult& method = result.of(*shown);
    std::vector<double> left;
    for (const identification::CaseEquations& rows : method.target_rows) {
      const Eigen::VectorXd residual = rows.right - rows.matrix * method.estimate.compliance;
      double longest = 0.0;
      for (Eigen::Index row = 0; row + 3 <= residual.size(); row += 3)
        longest = std::max(longest, residual.segment<3>(row).norm());
      left.push_back(longest);
    }
    addLongest(left);
  }
  if (one.diagnosis == nullptr || one.diagnosis->at_points.empty()) return named;
  for (const GapVector left : {&diagnosis::PointGap::before, &diagnosis::PointGap::after})
    named.insert(longestGap(*one.diagnosis, left).pose);
  return named;
}

std::string loadedSceneJson(const reports::ReportCampaign& one, const campaign::Campaign& raw) {
  if (one.identification.cases.empty()) return {};
  const std::size_t median = medianCase(one);
  const int first_posture = one.identification.cases[median].pose;
  const std::set<int> named = namedPoses(one);
  const auto wanted = [&](int posture) {
    return isShown(posture, one.campaign.pose_ids.size()) || named.contains(posture) || posture == first_posture;
  };
  const std::vector<identification::Method> shown = methodsOf(one.identification);
  const std::vector<ViewMaterial> materials = loadMaterials(one.campaign, one.identification, shown, wanted);
  const ViewMaterial& material = materials.front();
  std::vector<NamedMaterial> methods;
  for (std::size_t m = 0; m < shown.size(); ++m) methods.push_back({shown[m], materials[m]});
  std::optional<ViewMaterial> before;
  if (one.improved != nullptr && !one.improved->effects.added.empty())
    before = std::move(loadMaterials(raw, one.improved->without, {}, wanted).front());
  Json json = emptyScene(one);
  const render::ArmScene picture = deflectionScene(one);
  json["magnification"] = render::automaticMagnification(picture);
  json["residual_factor"] = picture.residual_factor;
  if (picture.view_direction) json["view"] = vectorJson(*picture.view_direction, 0.01);
  json["corrected"] = before.has_value();
  for (const NamedMaterial& method : methods)
    json["methods"].push_back(
        {{"key", reports::namesOf(method.method).key}, {"name", reports::namesOf(method.method).brief}});
  json["vectors"].push_back(vectorKind("m", "measured", "measured", 6, 20));
  if (!methods.empty()) {
    json["vectors"].push_back(vectorKind("p", "predicted", "predicted", 2.2, 10));
    json["vectors"].push_back(vectorKind("r", "residual", "residual", 3.5));
  }
  if (before) json["vectors"].push_back(vectorKind("e", "effects", "effects", 3.5));
  json["postures"] = one.campaign.pose_ids.size();
  for (std::size_t i = 0; i < material.frames.size(); ++i) {
    const ViewFrame& frame = material.frames[i];
    if (frame.posture == first_posture && frame.step == one.identification.step) json["first"] = json["frames"].size();
    Json made = frameJson(one.campaign.pose_ids[static_cast<std::size_t>(frame.posture)], frame.where, frame.load,
                          frame.posture, frame.step, frame.scene.poses.front());
    if (frame.force) made["force"] = vectorJson(*frame.force, 1.0);
    if (const auto& load = frame.scene.poses.front().load) made["load_at"] = placeJson(load->at);
    made["points"] = loadedPoints(frame, i, methods, before ? &*before : nullptr);
    json["frames"].push_back(std::move(made));
  }
  return sceneText(json);
}

std::string beginningAs(const std::string& scene, const reports::ReportCampaign& one, const DeflectionScene& picture) {
  Json json = Json::parse(scene);
  json["magnification"] = picture.scene.magnification.value_or(1.0);
  json["residual_factor"] = picture.scene.residual_factor;
  if (picture.scene.view_direction)
    json["view"] = vectorJson(*picture.scene.view_direction, 0.01);
  else
    json.erase("view");
  const identification::LoadCase& load_case = one.identification.cases[picture.load_case];
  const Json& frames = json["frames"];
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i]["posture"] == load_case.pose && frames[i]["step"] == load_case.step) json["first"] = i;
  }
  return sceneText(json);
}

namespace {

/// The frame whose largest vector is the median of all frames'.
std::size_t medianFrame(const Json& frames) {
  std::vector<std::pair<double, std::size_t>> largest;
  for (const Json& frame : frames) {
    double most = 0.0;
    for (const Json& point : frame["points"]) {
      const Json& m = point["m"];
      most = std::max(most, std::hypot(m[0].get<double>(), m[1].get<double>(), m[2].get<double>()));
    }
    largest.emplace_back(most, largest.size());
  }
  if (largest.empty()) return 0;
  std::sort(largest.begin(), largest.end());
  return largest[(largest.size() - 1) / 2].second;
}

}  // namespace

std::string accuracySceneJson(const reports::ReportCampaign& one) {
  if (one.accuracy == nullptr || !one.accuracy->calibration.reason.empty()) return {};
  using calibration::CalibratedModel;
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const frames::Frames& frames = one.identification.frames;
  const Eigen::Isometry3d& r0_from_base = frames.arm.r0_from_base_link;
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(frames));
  const bool effects = !calibration.best().fit.parts.empty();
  Json json = emptyScene(one);
  json["corrected"] = false;
  if (const auto scenes = accuracyScenes(one)) json["magnification"] = *scenes->before.magnification;
  json["vectors"].push_back(vectorKind("m", "left by the calibrated geometry", "measured", 6, 20));
  if (effects) {
    json["vectors"].push_back(vectorKind("r", "left with effects", "residual", 3.5));
    json["vectors"].push_back(vectorKind("e", "explained by the effects", "effects", 3.5));
  }
  std::size_t posture = calibration.day.postures.size();
  json["postures"] = posture;
  const std::vector<calibration::ReadingError> errors = calibration::readingErrors(calibration);
  const std::set<std::size_t> named = namedPostures(calibration, errors);
  for (const calibration::ReadingError& error : errors) {
    if (!isShown(static_cast<int>(error.posture), calibration.day.postures.size()) && !named.contains(error.posture))
      continue;
    if (!error.of(CalibratedModel::geometry).allFinite()) continue;
    if (error.posture != posture) {
      posture = error.posture;
      const auto& at = calibration.day.postures[posture];
      const std::string& id = calibration.day.pose_ids[static_cast<std::size_t>(at.pose)];
      json["frames"].push_back(
          frameJson(id, "posture " + id, "", at.pose, 0, bareArm(frames, robot::postureAt(frames.arm.arm, at.q))));
    }
    const Eigen::Vector3d left = r0_from_base.linear() * error.of(CalibratedModel::geometry);
    Json point{{"label", reports::pointName(calibration.day.targets[static_cast<std::size_t>(error.target)])},
               {"at", placeJson(r0_from_base * error.position + up)},
               {"m", moveJson(left)}};
    if (effects && error.of(CalibratedModel::effects).allFinite()) {
      const Eigen::Vector3d with = r0_from_base.linear() * error.of(CalibratedModel::effects);
      point["r"] = moveJson(with);
      point["e"] = moveJson(left - with);
    }
    json["frames"].back()["points"].push_back(std::move(point));
  }
  json["first"] = medianFrame(json["frames"]);
  return json["frames"].empty() ? std::string() : sceneText(json);
}

std::string sweepSceneJson(const reports::ReportCampaign& one) {
  const ViewMaterial material = sweepMaterial(one.campaign, one.identification.frames);
  if (material.frames.empty()) return {};
  Json json = emptyScene(one);
  json["traces"] = Json::array();
  for (const ViewFrame& frame : material.frames) {
    json["frames"].push_back(frameJson(frame.name, frame.where, "", frame.posture, 0, frame.scene.poses.front()));
    for (const render::SceneTrace& trace : frame.scene.traces) {
      if (trace.faint) continue;
      Json points = Json::array();
      for (const Eigen::Vector3d& point : trace.points) points.push_back(placeJson(point));
      json["traces"].push_back({{"axis", frame.posture}, {"points", std::move(points)}});
    }
  }
  return sceneText(json);
}

}  // namespace stiffscope::app
