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

bool hasVectors(const ArmScene& scene, SceneVector vector) {
  bool any = false;
  forEachPoint(scene,
               [&](const ScenePoint& point, const ArmPose&) { any = any || (point.*vector).has_value(); });
  return any;
}

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
    drawArrow(canvas, origin, tip, colours::kInk, 2 * stage.unit, 10 * stage.unit);
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
  if (hasVectors(scene, &ScenePoint::measured)) {
    legend.push_back({Key::ThickArrow, colours::kMeasured, scene.measured_name});
  }
  if (hasVectors(scene, &ScenePoint::predicted)) {
    legend.push_back({Key::ThinArrow, colours::kPredicted, scene.predicted_name});
  }
  takeLegend(canvas, free, legend);
  const double top = free.bottom - 26 * canvas.unit();
  return {{free.left, free.top, free.right, top - 6 * canvas.unit()},
          {free.left, top, free.right, free.bottom}};
}

void paintFloor(Canvas& canvas, const SceneStage& stage) {
  const FloorGrid floor = floorOf(stage.scene);
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    canvas.line(stage.projection.spotOf(from), stage.projection.spotOf(to), colours::kGrid,
                1.25 * stage.unit);
  };
  for (int i = floor.x_first; i <= floor.x_last; ++i)
    line(floor.at(i, floor.y_first), floor.at(i, floor.y_last));
  for (int j = floor.y_first; j <= floor.y_last; ++j)
    line(floor.at(floor.x_first, j), floor.at(floor.x_last, j));
}

void paintScale(Canvas& canvas, const SceneStage& stage, const Box& strip) {
  const double pixels_per_deflection = stage.magnification * stage.projection.pixelsPerMetre();
  const double reference = roundDown125(150 * stage.unit / pixels_per_deflection);
  const double length = reference * pixels_per_deflection;
  const double y = strip.middleY();
  const TextStyle style = labelStyle(canvas);
  drawArrow(canvas, {strip.left, y}, {strip.left + length, y}, colours::kInk, kMeasuredWidth * stage.unit,
            kHeadLength * stage.unit);
  const std::string text =
      fmt::format("{}   vectors \u00d7 {}", lengthText(reference), shortNumber(stage.magnification));
  canvas.text(text, {strip.left + length + 10 * stage.unit, y}, AlignX::Left, AlignY::Centre, style);
}

void paintLabels(Canvas& canvas, const SceneStage& stage) {
  LabelPlacer labels(canvas, stage.room);
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    const Spot spot = stage.projection.spotOf(point.position);
    const double r = 8 * stage.unit;
    labels.take({spot.x - r, spot.y - r, spot.x + r, spot.y + r});
    for (const auto& vector : {point.measured, point.predicted}) {
      if (!vector) continue;
      labels.takeLine(spot, stage.projection.spotOf(point.position + stage.magnification * *vector),
                      12 * stage.unit);
    }
  });
  // The axes stand on the arm's foot and so do their labels; those of the points keep clear of the arm.
  paintTriad(canvas, stage, labels);
  for (const ArmPose& pose : stage.scene.poses) {
    if (!pose.ghost) takeArm(labels, stage, pose);
  }
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose& pose) {
    if (pose.ghost || point.label.empty()) return;
    TextStyle style = labelStyle(canvas);
    style.bold = true;
    labels.place(point.label, stage.projection.spotOf(point.position), 11 * stage.unit, style);
  });
}

}  // namespace stiffscope
