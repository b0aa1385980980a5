#include "app/view/point_numbers.h"

#include <fmt/format.h>

#include <array>

#include "reports/page/html.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr double kMmPerM = 1e3;

struct Vector {
  const char* name;
  const std::optional<Eigen::Vector3d>& value;
  Colour colour;
};

std::array<Vector, 3> vectorsOf(const ScenePoint& point, const Palette& palette) {
  return {{{"measured", point.measured, palette.measured},
           {"predicted", point.predicted, palette.predicted},
           {"residual", point.residual, palette.residual}}};
}

std::vector<std::string> cells(const std::string& name, const Eigen::Vector3d& v, int decimals) {
  return {name, page::fixed(v.x(), decimals), page::fixed(v.y(), decimals), page::fixed(v.z(), decimals),
          page::fixed(v.norm(), decimals)};
}

}  // namespace

ScenePanel pointPanel(const ViewFrame& frame, const ScenePoint& point, bool dark) {
  ScenePanel panel;
  panel.numbers = true;
  panel.title = fmt::format("{} in {}", point.label, frame.where);
  panel.rows.push_back({{"in R_{0}, mm", "x_{0}", "y_{0}", "z_{0}", "length"}, std::nullopt});
  for (const Vector& vector : vectorsOf(point, dark ? kDarkPalette : kLightPalette)) {
    if (vector.value) panel.rows.push_back({cells(vector.name, kMmPerM * *vector.value, 3), vector.colour});
  }
  panel.rows.push_back(
      {cells("stands at", kMmPerM * (point.position - frame.scene.frame_origin), 1), std::nullopt});
  panel.rows.back().cells.pop_back();
  if (frame.force) panel.rows.push_back({cells("force, N", *frame.force, 0), std::nullopt});
  return panel;
}

std::string pointText(const ViewFrame& frame, const ScenePoint& point) {
  std::string text = fmt::format("{}, {}", page::plain(point.label), frame.where);
  if (!frame.load.empty()) text += ", " + frame.load;
  if (frame.force) {
    text +=
        fmt::format(", force {:.1f} {:.1f} {:.1f} N", frame.force->x(), frame.force->y(), frame.force->z());
  }
  text += '\n';
  for (const Vector& vector : vectorsOf(point, kLightPalette)) {
    if (!vector.value) continue;
    const Eigen::Vector3d mm = kMmPerM * *vector.value;
    text += fmt::format("  {:<9} {:>9.4f} {:>9.4f} {:>9.4f}  length {:.4f} mm\n", vector.name, mm.x(), mm.y(),
                        mm.z(), mm.norm());
  }
  return text;
}

}  // namespace stiffscope
