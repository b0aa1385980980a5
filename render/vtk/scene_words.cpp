// The flat parts of the picture of an arm: what stands around it, the floor, the scale, the labels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/ticks.h"
#include "render/vtk/arm_shape.h"
#include "render/vtk/chart_frame.h"
#include "render/vtk/marks.h"
#include "render/vtk/scene_labels.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

namespace {

std::string lengthText(double metres) {
  return metres < 1e-4 ? shortNumber(metres * 1e6) + " \u00b5m" : shortNumber(metres * 1e3) + " mm";
}

void takeArm(LabelPlacer& labels, const SceneStage& stage, const ArmPose& pose) {
  const ArmProportions proportions(pose);
  const auto take = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
    labels.takeLine(stage.projection.spotOf(from), stage.projection.spotOf(to),
                    std::max(4.0, 2 * radius * stage.projection.pixelsPerMetre()));
  };
  double along = 0;
  for (std::size_t i = 1; i < pose.joint_points.size(); ++i) {
    take(pose.joint_points[i - 1], pose.joint_points[i], proportions.radiusAt(along));
    along += (pose.joint_points[i] - pose.joint_points[i - 1]).norm();
  }
  for (const ScenePoint& target : pose.targets)
    take(pose.joint_points.back(), target.position, proportions.tip_radius);
}

void paintTriad(Canvas& canvas, const SceneStage& stage, LabelPlacer& labels) {
  const double length = 70 * stage.unit / stage.projection.pixelsPerMetre();
  const Spot origin = stage.projection.spotOf(stage.scene.frame_origin);
  const char* names[] = {"x_{0}", "y_{0}", "z_{0}"};
  for (int i = 0; i < 3; ++i) {
    const Spot tip = stage.projection.spotOf(stage.scene.frame_origin + length * Eigen::Vector3d::Unit(i));
    // An axis seen end on has no direction to draw.
    if (std::hypot(tip.x - origin.x, tip.y - origin.y) < 12 * stage.unit) continue;
    drawArrow(canvas, origin, tip, stage.surface.palette.ink, 2 * stage.unit, 10 * stage.unit);
    labels.takeLine(origin, tip, 6 * stage.unit);
    labels.place(names[i], tip, 4 * stage.unit, labelStyle(canvas));
  }
}

}  // namespace

SceneLayout paintSurroundings(Canvas& canvas, const ArmScene& scene) {
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, scene.title, scene.subtitle);
  std::vector<LegendEntry> legend;
  constexpr std::array kKeys{Key::ThickArrow, Key::ThinArrow, Key::MediumArrow};
  const auto kinds = vectorKinds(scene);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!hasVectors(scene, kinds[i])) continue;
    const std::string longer =
        kinds[i].factor == 1 ? "" : fmt::format(", {} times longer", shortNumber(kinds[i].factor));
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
  const std::string text = fmt::format("{}   {} \u00d7 {}", lengthText(reference), what, shortNumber(factor));
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

namespace {

bool inRoom(const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot spot = stage.projection.spotOf(point);
  return spot.x >= stage.room.left && spot.x <= stage.room.right && spot.y >= stage.room.top &&
         spot.y <= stage.room.bottom;
}

void paintRing(Canvas& canvas, const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot centre = stage.projection.spotOf(point);
  const double radius = 15 * stage.unit;
  constexpr int kPieces = 40;
  const auto at = [&](int i) {
    const double angle = 2 * M_PI * i / kPieces;
    return Spot{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
  };
  for (const auto& [colour, width] :
       {std::pair{canvas.palette().paper, 5.0}, std::pair{canvas.palette().ink, 2.5}}) {
    for (int i = 0; i < kPieces; ++i) canvas.line(at(i), at(i + 1), colour, width * stage.unit);
  }
}

}  // namespace

void paintLabels(Canvas& canvas, const SceneStage& stage) {
  if (stage.scene.picked) paintRing(canvas, stage, *stage.scene.picked);
  LabelPlacer labels(canvas, stage.room);
  const auto kinds = vectorKinds(stage.scene);
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    const Spot spot = stage.projection.spotOf(point.position);
    const double r = 8 * stage.unit;
    labels.take({spot.x - r, spot.y - r, spot.x + r, spot.y + r});
    for (const VectorKind& kind : kinds) {
      if (!(point.*kind.vector)) continue;
      const Eigen::Vector3d drawn = stage.magnification * kind.factor * *(point.*kind.vector);
      labels.takeLine(spot, stage.projection.spotOf(point.position + drawn), 12 * stage.unit);
    }
  });
  // The axes stand on the arm's foot and so do their labels; those of the points keep clear of the arm.
  paintTriad(canvas, stage, labels);
  for (const ArmPose& pose : stage.scene.poses) {
    if (!pose.ghost) takeArm(labels, stage, pose);
  }
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose& pose) {
    if (pose.ghost || point.label.empty() || !inRoom(stage, point.position)) return;
    TextStyle style = labelStyle(canvas);
    style.bold = true;
    labels.place(point.label, stage.projection.spotOf(point.position), 11 * stage.unit, style);
  });
  for (const SceneTrace& trace : stage.scene.traces) {
    if (trace.faint || trace.points.empty() || trace.label.empty()) continue;
    if (!inRoom(stage, trace.points.back())) continue;
    labels.place(trace.label, stage.projection.spotOf(trace.points.back()), 11 * stage.unit,
                 labelStyle(canvas));
  }
}

}  // namespace stiffscope
