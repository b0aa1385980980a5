// What stands at the points of a scene: the base frame's axes, labels, the ring around the picked one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "render/vtk/arm_shape.h"
#include "render/vtk/chart_frame.h"
#include "render/vtk/marks.h"
#include "render/vtk/scene_labels.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

namespace {

bool inRoom(const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot spot = stage.projection.spotOf(point);
  return spot.x >= stage.room.left && spot.x <= stage.room.right && spot.y >= stage.room.top &&
         spot.y <= stage.room.bottom;
}

/// Radius of the balls of the targets on the picture.
double ballPixels(const SceneStage& stage, const ArmPose& pose) {
  return ArmProportions(pose).target_radius * stage.projection.pixelsPerMetre();
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

void paintRing(Canvas& canvas, const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot centre = stage.projection.spotOf(point);
  const double radius = std::max(15 * stage.unit, 1.4 * ballPixels(stage, stage.scene.poses.front()));
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
    const double r = std::max(8 * stage.unit, ballPixels(stage, stage.scene.poses.front()));
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
    const double clearance = std::max(11 * stage.unit, ballPixels(stage, pose) + 4 * stage.unit);
    labels.place(point.label, stage.projection.spotOf(point.position), clearance, style);
  });
  for (const SceneTrace& trace : stage.scene.traces) {
    if (trace.faint || trace.points.empty() || trace.label.empty()) continue;
    if (!inRoom(stage, trace.points.back())) continue;
    labels.place(trace.label, stage.projection.spotOf(trace.points.back()), 11 * stage.unit,
                 labelStyle(canvas));
  }
}

}  // namespace stiffscope
