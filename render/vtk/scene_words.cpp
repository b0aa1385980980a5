// The flat parts of the picture of an arm: what stands around it, the floor, the scale.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/ticks.h"
#include "render/vtk/arm_shape.h"
#include "render/vtk/chart_frame.h"
#include "render/vtk/marks.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

namespace {

std::string lengthText(double metres) {
  return metres < 1e-4 ? shortNumber(metres * 1e6) + " \u00b5m" : shortNumber(metres * 1e3) + " mm";
}

}  // namespace

SceneLayout paintSurroundings(Canvas& canvas, const ArmScene& scene) {
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, scene.title, scene.subtitle);
  std::vector<LegendEntry> legend;
  constexpr std::array kKeys{Key::ThickArrow, Key::ThinArrow, Key::MediumArrow};
  const auto kinds = vectorKinds(scene);
  const bool others = hasVectors(scene, kinds[0]) || hasVectors(scene, kinds[1]);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!hasVectors(scene, kinds[i])) continue;
    const bool alone = kinds[i].factor == 1 || !others;
    const std::string longer =
        alone ? "" : fmt::format(", {} times longer", shortNumber(kinds[i].factor));
    legend.push_back({kKeys[i], kinds[i].colour, kinds[i].name.empty() ? "" : kinds[i].name + longer});
  }
  if (!scene.traces.empty()) legend.push_back({Key::Point, canvas.palette().measured, scene.trace_name});
  takeLegend(canvas, free, legend);
  takeNote(canvas, free, scene.note);
  const double top = free.bottom - 26 * canvas.unit();
  Box room{free.left, free.top, free.right, top - 6 * canvas.unit()};
  takePanels(canvas, room, scene.panels);
  return {room, {free.left, top, free.right, free.bottom}};
}

void paintFloor(Canvas& canvas, const SceneStage& stage) {
  const FloorGrid floor = floorOf(stage.scene);
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    canvas.line(stage.projection.spotOf(from), stage.projection.spotOf(to), stage.surface.palette.grid,
                1.25 * stage.unit);
  };
  for (int i = floor.x_first; i <= floor.x_last; ++i)
    line(floor.at(i, floor.y_first), floor.at(i, floor.y_last));
  for (int j = floor.y_first; j <= floor.y_last; ++j)
    line(floor.at(floor.x_first, j), floor.at(floor.x_last, j));
}

namespace {

/// One reference arrow from `left` on with its words; returns where it ends.
double paintReference(Canvas& canvas, const SceneStage& stage, double factor, const VectorKind& look,
                      const std::string& what, Spot left) {
  const double pixels_per_deflection = factor * stage.projection.pixelsPerMetre();
  const double reference = roundDown125(150 * stage.unit / pixels_per_deflection);
  const Spot tip{left.x + reference * pixels_per_deflection, left.y};
  drawArrow(canvas, left, tip, look.colour, look.width * stage.unit, kHeadLength * stage.unit);
  const std::string text = fmt::format("{}   {} \u00d7 {}", lengthText(reference), what, factorText(factor));
  const Spot at{tip.x + 10 * stage.unit, left.y};
  canvas.text(text, at, AlignX::Left, AlignY::Centre, labelStyle(canvas));
  return at.x + canvas.measure(text, labelStyle(canvas)).x;
}

}  // namespace

void paintScale(Canvas& canvas, const SceneStage& stage, const Box& strip) {
  auto kinds = vectorKinds(stage.scene);
  const bool residual = hasVectors(stage.scene, kinds[2]);
  const bool others = hasVectors(stage.scene, kinds[0]) || hasVectors(stage.scene, kinds[1]);
  if (!residual && !others && !stage.scene.traces.empty()) return;
  double left = strip.left;
  if (others || !residual) {
    kinds[0].colour = stage.surface.palette.ink;  // stands for measured and predicted ones
    left = paintReference(canvas, stage, stage.magnification, kinds[0], "vectors", {left, strip.middleY()});
    left += 40 * stage.unit;
  }
  if (residual && (!others || kinds[2].factor != 1)) {
    paintReference(canvas, stage, stage.magnification * kinds[2].factor, kinds[2], "residual",
                   {left, strip.middleY()});
  }
}

}  // namespace stiffscope
