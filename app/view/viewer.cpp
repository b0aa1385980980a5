#include "app/view/viewer.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/view/view_material.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

/// The displacements of one point by coordinate of R0, mm, and the load: for the panel beside the scene.
render::ScenePanel pointPanel(const ViewFrame& frame, const render::ScenePoint& point, bool dark);

/// The same as text, and with the posture: for standard output.
std::string pointText(const ViewFrame& frame, const render::ScenePoint& point);

/// The magnification, and the factor of the residual vectors, that suit a load step: the median over its
/// postures of what suits each, so that one posture with much deflection does not make the others' arrows
/// short. 1 where there are no vectors.
double magnificationForStep(const std::vector<ViewFrame>& frames, int step, double residual_factor);
double residualFactorForStep(const std::vector<ViewFrame>& frames, int step);

namespace {

struct Vector {
  const char* name;
  const std::optional<Eigen::Vector3d>& value;
  render::Colour colour;
};

std::array<Vector, 3> vectorsOf(const render::ScenePoint& point, const render::Palette& palette) {
  return {{{"measured", point.measured, palette.measured},
           {"predicted", point.predicted, palette.predicted},
           {"residual", point.residual, palette.residual}}};
}

std::vector<std::string> cells(const std::string& name, const Eigen::Vector3d& v, int decimals) {
  return {name, reports::fixed(v.x(), decimals), reports::fixed(v.y(), decimals), reports::fixed(v.z(), decimals),
          reports::fixed(v.norm(), decimals)};
}

}  // namespace

render::ScenePanel pointPanel(const ViewFrame& frame, const render::ScenePoint& point, bool dark) {
  render::ScenePanel panel;
  panel.numbers = true;
  panel.title = fmt::format("{} in {}", point.label, frame.where);
  panel.rows.push_back({{"in R_{0}, mm", "x_{0}", "y_{0}", "z_{0}", "length"}, std::nullopt});
  for (const Vector& vector : vectorsOf(point, dark ? render::kDarkPalette : render::kLightPalette)) {
    if (vector.value) panel.rows.push_back({cells(vector.name, reports::kMmPerM * *vector.value, 3), vector.colour});
  }
  panel.rows.push_back(
      {cells("stands at", reports::kMmPerM * (point.position - frame.scene.frame_origin), 1), std::nullopt});
  panel.rows.back().cells.pop_back();
  if (frame.force) panel.rows.push_back({cells("force, N", *frame.force, 0), std::nullopt});
  return panel;
}

std::string pointText(const ViewFrame& frame, const render::ScenePoint& point) {
  std::string text = fmt::format("{}, {}", reports::plain(point.label), frame.where);
  if (!frame.load.empty()) text += ", " + frame.load;
  if (frame.force) {
    text += fmt::format(", force {:.1f} {:.1f} {:.1f} N", frame.force->x(), frame.force->y(), frame.force->z());
  }
  text += '\n';
  for (const Vector& vector : vectorsOf(point, render::kLightPalette)) {
    if (!vector.value) continue;
    const Eigen::Vector3d mm = reports::kMmPerM * *vector.value;
    text += fmt::format("  {:<9} {:>9.4f} {:>9.4f} {:>9.4f}  length {:.4f} mm\n", vector.name, mm.x(), mm.y(), mm.z(),
                        mm.norm());
  }
  return text;
}

namespace {

double medianOverStep(const std::vector<ViewFrame>& frames, int step,
                      const std::function<std::optional<double>(const render::ArmScene&)>& value) {
  std::vector<double> values;
  for (const ViewFrame& frame : frames) {
    if (frame.step != step) continue;
    if (const auto one = value(frame.scene)) values.push_back(*one);
  }
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double magnificationForStep(const std::vector<ViewFrame>& frames, int step, double residual_factor) {
  return medianOverStep(frames, step, [&](render::ArmScene scene) -> std::optional<double> {
    scene.residual_factor = residual_factor;
    const double suits = render::automaticMagnification(scene);
    return suits == 1 ? std::nullopt : std::optional(suits);  // 1: there is no vector
  });
}

double residualFactorForStep(const std::vector<ViewFrame>& frames, int step) {
  return medianOverStep(frames, step, [](const render::ArmScene& scene) {
    return std::optional(render::automaticResidualFactor(scene));
  });
}

namespace {

constexpr double kTurnByKey = M_PI / 18;
constexpr double kZoom = 1.2;

}  // namespace

const std::vector<ViewKey>& viewKeys() {
  static const std::vector<ViewKey> keys{
      {{"Right", "Next"}, "\u2190 \u2192", "posture", [](Viewer& v) { v.stepPosture(1); }},
      {{"Left", "Prior"}, "", "", [](Viewer& v) { v.stepPosture(-1); }},
      {{"Up"}, "\u2191 \u2193", "load step", [](Viewer& v) { v.stepLoad(1); }},
      {{"Down"}, "", "", [](Viewer& v) { v.stepLoad(-1); }},
      {{"m"}, "m", "measured on/off", [](Viewer& v) { v.settings_.measured = !v.settings_.measured; }},
      {{"p"}, "p", "predicted on/off", [](Viewer& v) { v.settings_.predicted = !v.settings_.predicted; }},
      {{"r"}, "r", "residual on/off", [](Viewer& v) { v.settings_.residual = !v.settings_.residual; }},
      {{"plus", "equal", "KP_Add"},
       "+ \u2212",
       "longer, shorter vectors",
       [](Viewer& v) { v.settings_.magnification = std::min(2 * v.settings_.magnification, 1e6); }},
      {{"minus", "underscore", "KP_Subtract"},
       "",
       "",
       [](Viewer& v) { v.settings_.magnification = std::max(v.settings_.magnification / 2, 1e-3); }},
      {{"a"}, "a", "length to suit", [](Viewer& v) { v.suitMagnification(); }},
      {{"period", "greater"}, ". ,", "longer, shorter residuals", [](Viewer& v) { v.changeResidualFactor(true); }},
      {{"comma", "less"}, "", "", [](Viewer& v) { v.changeResidualFactor(false); }},
      {{"n"}, "n", "next method", [](Viewer& v) { v.nextMethod(); }},
      {{"Tab"}, "Tab", "next point's numbers", [](Viewer& v) { v.pickNext(); }},
      {{"1", "KP_1"}, "1 2 3 4", "front, side, top, oblique", [](Viewer& v) { v.window_.look(render::View::front); }},
      {{"2", "KP_2"}, "", "", [](Viewer& v) { v.window_.look(render::View::side); }},
      {{"3", "KP_3"}, "", "", [](Viewer& v) { v.window_.look(render::View::top); }},
      {{"4", "KP_4"}, "", "", [](Viewer& v) { v.window_.look(render::View::oblique); }},
      {{"Shift+Right"}, "Shift+arrow", "turn", [](Viewer& v) { v.window_.turn(kTurnByKey, 0); }},
      {{"Shift+Left"}, "", "", [](Viewer& v) { v.window_.turn(-kTurnByKey, 0); }},
      {{"Shift+Down"}, "", "", [](Viewer& v) { v.window_.turn(0, kTurnByKey); }},
      {{"Shift+Up"}, "", "", [](Viewer& v) { v.window_.turn(0, -kTurnByKey); }},
      {{"i"}, "i o", "nearer, farther", [](Viewer& v) { v.window_.zoom(kZoom); }},
      {{"o"}, "", "", [](Viewer& v) { v.window_.zoom(1 / kZoom); }},
      {{"b"}, "b", "light, dark background", [](Viewer& v) { v.settings_.dark = !v.settings_.dark; }},
      {{"s"}, "s", "save the picture (PNG)", [](Viewer& v) { v.save(); }},
      {{"0", "KP_0", "Home"}, "0", "reset", [](Viewer& v) { v.reset(); }},
      {{"h", "question"}, "h ?", "this list", [](Viewer& v) { v.settings_.keys_listed = !v.settings_.keys_listed; }},
      {{"q", "Escape"}, "q", "quit", [](Viewer& v) { v.window_.close(); }},
  };
  return keys;
}

namespace {

/// What is not a key.
const std::vector<std::pair<std::string, std::string>> kMouse{
    {"drag", "turn"}, {"right drag", "shift"}, {"wheel", "zoom"}, {"click", "a point's numbers"}};

}  // namespace

render::ScenePanel keysPanel() {
  render::ScenePanel panel;
  panel.title = "Keys";
  for (const ViewKey& key : viewKeys()) {
    if (!key.shown.empty()) panel.rows.push_back({{key.shown, key.does}, std::nullopt});
  }
  for (const auto& [shown, does] : kMouse) panel.rows.push_back({{shown, does}, std::nullopt});
  return panel;
}

std::string keysText() {
  std::string text = "Keys in the window:\n";
  for (const render::ScenePanel::Row& row : keysPanel().rows) {
    text += fmt::format("  {:<12} {}\n", row.cells[0], row.cells[1]);
  }
  return text;
}

namespace {

std::vector<const render::ScenePoint*> pointsToPick(const render::ArmScene& scene) {
  std::vector<const render::ScenePoint*> points;
  for (const render::ScenePoint& target : scene.poses.front().targets) points.push_back(&target);
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
  settings_.magnification = magnification.value_or(magnificationForStep(frames, step, settings_.residual_factor));
  start_ = settings_;
  for (const ViewFrame& one : frames) {
    if (one.step != step) continue;
    render::ArmScene scene = one.scene;
    scene.residual_factor = settings_.residual_factor;
    const auto points = render::pointsOf(scene, settings_.magnification);
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
    const auto at = static_cast<std::size_t>(((static_cast<std::ptrdiff_t>(at_) + by * away) % count + count) % count);
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

const render::ScenePoint* Viewer::pickedPoint() const {
  if (picked_.empty()) return nullptr;
  for (const render::ScenePoint* point : pointsToPick(frame().scene)) {
    if (point->label == picked_) return point;
  }
  return nullptr;
}

void Viewer::nextMethod() {
  if (by_method_.size() < 2) message_ = material().method.empty() ? material().lacking : "this is the only method";
  method_ = (method_ + 1) % by_method_.size();
}

void Viewer::suitMagnification() {
  render::ArmScene shown = frame().scene;
  shown.residual_factor = settings_.residual_factor;
  showOnlyWanted(shown);
  settings_.magnification = render::automaticMagnification(shown);
}

void Viewer::changeResidualFactor(bool longer) {
  const double now = settings_.residual_factor;
  settings_.residual_factor =
      longer ? std::min(1000.0, render::roundUp125(1.5 * now)) : std::max(1.0, render::roundDown125(now / 1.5));
}

void Viewer::reset() {
  const bool keys_listed = settings_.keys_listed;
  settings_ = start_;
  settings_.keys_listed = keys_listed;
  picked_.clear();
  window_.look(render::View::oblique);
}

void Viewer::save() { message_ = window_.save(frame().name); }

void Viewer::showOnlyWanted(render::ArmScene& scene) const {
  const auto strip = [&](render::ScenePoint& point) {
    if (!settings_.measured) point.measured.reset();
    if (!settings_.predicted) point.predicted.reset();
    if (!settings_.residual) point.residual.reset();
  };
  for (render::ArmPose& pose : scene.poses) {
    for (render::ScenePoint& target : pose.targets) strip(target);
    if (pose.wrist) strip(*pose.wrist);
  }
}

render::ArmScene Viewer::scene() const {
  render::ArmScene scene = frame().scene;
  showOnlyWanted(scene);
  scene.magnification = settings_.magnification;
  scene.residual_factor = settings_.residual_factor;
  scene.also_fitted = also_fitted_;
  scene.dark = settings_.dark;
  scene.note = message_.empty() ? status() : message_;
  if (!settings_.keys_listed && settings_.keys_work) scene.note += "   \u00b7   h: keys";
  if (const render::ScenePoint* point = pickedPoint()) {
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
  std::string text = fmt::format("{} ({} of {})", frame().where,
                                 std::distance(postures.begin(), postures.find(frame().posture)) + 1, postures.size());
  if (frame().load.empty()) return text;
  text += fmt::format("   \u00b7   {}   \u00b7   vectors \u00d7 {}", frame().load,
                      render::factorText(settings_.magnification));
  text += "   \u00b7   " + (material().method.empty() ? material().lacking : "predicted by " + material().method);
  return text;
}

std::string Viewer::title() const {
  std::string text = frame().where;
  if (!frame().load.empty()) {
    text += fmt::format(", {}, vectors \u00d7 {}", frame().load, render::factorText(settings_.magnification));
  }
  return fmt::format("{} \u2013 {} \u2013 stiffscope", text, material().campaign);
}

}  // namespace stiffscope::app
