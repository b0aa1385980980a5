#include "app/view/view_keys.h"

#include <fmt/format.h>

#include <cmath>

namespace stiffscope {

namespace {

constexpr double kTurn = M_PI / 18;
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
      {{"period", "greater"},
       ". ,",
       "longer, shorter residuals",
       [](Viewer& v) { v.changeResidualFactor(true); }},
      {{"comma", "less"}, "", "", [](Viewer& v) { v.changeResidualFactor(false); }},
      {{"n"}, "n", "next method", [](Viewer& v) { v.nextMethod(); }},
      {{"Tab"}, "Tab", "next point's numbers", [](Viewer& v) { v.pickNext(); }},
      {{"1", "KP_1"}, "1 2 3 4", "front, side, top, oblique", [](Viewer& v) { v.window_.look(View::Front); }},
      {{"2", "KP_2"}, "", "", [](Viewer& v) { v.window_.look(View::Side); }},
      {{"3", "KP_3"}, "", "", [](Viewer& v) { v.window_.look(View::Top); }},
      {{"4", "KP_4"}, "", "", [](Viewer& v) { v.window_.look(View::Oblique); }},
      {{"Shift+Right"}, "Shift+arrow", "turn", [](Viewer& v) { v.window_.turn(kTurn, 0); }},
      {{"Shift+Left"}, "", "", [](Viewer& v) { v.window_.turn(-kTurn, 0); }},
      {{"Shift+Down"}, "", "", [](Viewer& v) { v.window_.turn(0, kTurn); }},
      {{"Shift+Up"}, "", "", [](Viewer& v) { v.window_.turn(0, -kTurn); }},
      {{"i"}, "i o", "nearer, farther", [](Viewer& v) { v.window_.zoom(kZoom); }},
      {{"o"}, "", "", [](Viewer& v) { v.window_.zoom(1 / kZoom); }},
      {{"b"}, "b", "light, dark background", [](Viewer& v) { v.settings_.dark = !v.settings_.dark; }},
      {{"s"}, "s", "save the picture (PNG)", [](Viewer& v) { v.save(); }},
      {{"0", "KP_0", "Home"}, "0", "reset", [](Viewer& v) { v.reset(); }},
      {{"h", "question"},
       "h ?",
       "this list",
       [](Viewer& v) { v.settings_.keys_listed = !v.settings_.keys_listed; }},
      {{"q", "Escape"}, "q", "quit", [](Viewer& v) { v.window_.close(); }},
  };
  return keys;
}

namespace {

/// What is not a key.
const std::vector<std::pair<std::string, std::string>> kMouse{
    {"drag", "turn"}, {"right drag", "shift"}, {"wheel", "zoom"}, {"click", "a point's numbers"}};

}  // namespace

ScenePanel keysPanel() {
  ScenePanel panel;
  panel.title = "Keys";
  for (const ViewKey& key : viewKeys()) {
    if (!key.shown.empty()) panel.rows.push_back({{key.shown, key.does}, std::nullopt});
  }
  for (const auto& [shown, does] : kMouse) panel.rows.push_back({{shown, does}, std::nullopt});
  return panel;
}

std::string keysText() {
  std::string text = "Keys in the window:\n";
  for (const ScenePanel::Row& row : keysPanel().rows) {
    text += fmt::format("  {:<12} {}\n", row.cells[0], row.cells[1]);
  }
  return text;
}

}  // namespace stiffscope
