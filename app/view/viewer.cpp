#include "app/view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "app/view/point_numbers.h"
#include "app/view/suiting_lengths.h"
#include "app/view/view_keys.h"
#include "render/ticks.h"

namespace stiffscope {

namespace {

std::vector<const ScenePoint*> pointsToPick(const ArmScene& scene) {
  std::vector<const ScenePoint*> points;
  for (const ScenePoint& target : scene.poses.front().targets) points.push_back(&target);
  if (scene.poses.front().wrist) points.push_back(&*scene.poses.front().wrist);
  return points;
}

}  // namespace

Viewer::Viewer(std::vector<ViewMaterial> by_method, std::size_t first, std::optional<double> magnification,
               ViewWindow window)
    : by_method_(std::move(by_method)), at_(first), window_(std::move(window)) {
  const std::vector<ViewFrame>& frames = material().frames;
  const int step = frame().step;
  settings_.residual_factor = residualFactorForStep(frames, step);
  settings_.magnification =
      magnification.value_or(magnificationForStep(frames, step, settings_.residual_factor));
  start_ = settings_;
  for (const ViewFrame& one : frames) {
    if (one.step != step) continue;
    ArmScene scene = one.scene;
    scene.residual_factor = settings_.residual_factor;
    const auto points = pointsOf(scene, settings_.magnification);
    also_fitted_.insert(also_fitted_.end(), points.begin(), points.end());
  }
}

void Viewer::press(const std::string& key) {
  for (const ViewKey& known : viewKeys()) {
    if (std::find(known.names.begin(), known.names.end(), key) == known.names.end()) continue;
    message_.clear();
    known.act(*this);
    return;
  }
}

void Viewer::stepPosture(int by) {
  const std::vector<ViewFrame>& frames = material().frames;
  const auto same = [&](std::size_t at) { return frames[at].step == frame().step; };
  const auto count = static_cast<std::ptrdiff_t>(frames.size());
  // Around the end, back to the first.
  for (std::ptrdiff_t away = 1; away <= count; ++away) {
    const auto at =
        static_cast<std::size_t>(((static_cast<std::ptrdiff_t>(at_) + by * away) % count + count) % count);
    if (!same(at)) continue;
    at_ = at;
    return;
  }
}

void Viewer::stepLoad(int by) {
  const std::vector<ViewFrame>& frames = material().frames;
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(at_) + by;
       at >= 0 && at < static_cast<std::ptrdiff_t>(frames.size()); at += by) {
    const auto found = static_cast<std::size_t>(at);
    if (frames[found].posture != frame().posture || frames[found].step == frame().step) continue;
    at_ = found;
    return;
  }
  if (!frame().load.empty()) message_ = by > 0 ? "this is the last load step" : "this is the first load step";
}

void Viewer::pickNext() {
  const auto points = pointsToPick(frame().scene);
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i]->label == picked_) next = i + 1;
  }
  pick(next < points.size() ? std::optional(next) : std::nullopt);
}

void Viewer::pick(std::optional<std::size_t> point) {
  const auto points = pointsToPick(frame().scene);
  picked_.clear();
  message_.clear();
  if (!point || *point >= points.size()) return;
  picked_ = points[*point]->label;
  window_.say(pointText(frame(), *points[*point]));
}

const ScenePoint* Viewer::pickedPoint() const {
  if (picked_.empty()) return nullptr;
  for (const ScenePoint* point : pointsToPick(frame().scene)) {
    if (point->label == picked_) return point;
  }
  return nullptr;
}

void Viewer::nextMethod() {
  if (by_method_.size() < 2)
    message_ = material().method.empty() ? material().lacking : "this is the only method";
  method_ = (method_ + 1) % by_method_.size();
}

void Viewer::suitMagnification() {
  ArmScene shown = frame().scene;
  shown.residual_factor = settings_.residual_factor;
  showOnlyWanted(shown);
  settings_.magnification = automaticMagnification(shown);
}

void Viewer::changeResidualFactor(bool longer) {
  const double now = settings_.residual_factor;
  settings_.residual_factor =
      longer ? std::min(1000.0, roundUp125(1.5 * now)) : std::max(1.0, roundDown125(now / 1.5));
}

void Viewer::reset() {
  const bool keys_listed = settings_.keys_listed;
  settings_ = start_;
  settings_.keys_listed = keys_listed;
  picked_.clear();
  window_.look(View::Oblique);
}

void Viewer::save() { message_ = window_.save(frame().name); }

void Viewer::showOnlyWanted(ArmScene& scene) const {
  const auto strip = [&](ScenePoint& point) {
    if (!settings_.measured) point.measured.reset();
    if (!settings_.predicted) point.predicted.reset();
    if (!settings_.residual) point.residual.reset();
  };
  for (ArmPose& pose : scene.poses) {
    for (ScenePoint& target : pose.targets) strip(target);
    if (pose.wrist) strip(*pose.wrist);
  }
}

ArmScene Viewer::scene() const {
  ArmScene scene = frame().scene;
  showOnlyWanted(scene);
  scene.magnification = settings_.magnification;
  scene.residual_factor = settings_.residual_factor;
  scene.also_fitted = also_fitted_;
  scene.dark = settings_.dark;
  scene.note = message_.empty() ? status() : message_;
  if (!settings_.keys_listed && settings_.keys_work) scene.note += "   \u00b7   h: keys";
  if (const ScenePoint* point = pickedPoint()) {
    scene.picked = point->position;
    scene.panels.push_back(pointPanel(frame(), *point, settings_.dark));
  }
  if (settings_.keys_listed) scene.panels.push_back(keysPanel());
  return scene;
}

std::string Viewer::status() const {
  std::set<int> postures;
  for (const ViewFrame& one : material().frames) {
    if (one.step == frame().step) postures.insert(one.posture);
  }
  std::string text =
      fmt::format("{} ({} of {})", frame().where,
                  std::distance(postures.begin(), postures.find(frame().posture)) + 1, postures.size());
  if (frame().load.empty()) return text;
  text += fmt::format("   \u00b7   {}   \u00b7   vectors \u00d7 {}", frame().load,
                      factorText(settings_.magnification));
  text +=
      "   \u00b7   " + (material().method.empty() ? material().lacking : "predicted by " + material().method);
  return text;
}

std::string Viewer::title() const {
  std::string text = frame().where;
  if (!frame().load.empty()) {
    text += fmt::format(", {}, vectors \u00d7 {}", frame().load, factorText(settings_.magnification));
  }
  return fmt::format("{} \u2013 {} \u2013 stiffscope", text, material().campaign);
}

}  // namespace stiffscope
