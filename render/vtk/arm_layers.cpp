#include "render/vtk/arm_layers.h"

#include <fmt/format.h>
#include <vtkRenderer.h>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "render/arm_scene.h"
#include "render/vtk/arm_shape.h"

namespace stiffscope::render {

/// Throws std::invalid_argument, as arm_scene.h says, with the offending numbers.
void requireDrawable(const ArmScene& scene);

namespace {

void requireFinite(const Eigen::Vector3d& v, const std::string& what) {
  if (v.allFinite()) return;
  throw std::invalid_argument(
      fmt::format("arm scene: {} is ({}, {}, {}), expected finite numbers", what, v.x(), v.y(), v.z()));
}

void requireFinite(const ScenePoint& point) {
  requireFinite(point.position, fmt::format("the position of '{}'", point.label));
  if (point.measured) requireFinite(*point.measured, fmt::format("the measured vector of '{}'", point.label));
  if (point.predicted) requireFinite(*point.predicted, fmt::format("the predicted vector of '{}'", point.label));
  if (point.residual) requireFinite(*point.residual, fmt::format("the residual vector of '{}'", point.label));
}

void requirePositive(double number, const std::string& what) {
  if (std::isfinite(number) && number > 0) return;
  throw std::invalid_argument(fmt::format("arm scene: {} {}, expected above zero", what, number));
}

void requireDrawable(const ArmPose& pose) {
  const std::size_t points = pose.joint_points.size();
  if (points < 2 || pose.axis_directions.size() + 1 != points) {
    throw std::invalid_argument(
        fmt::format("arm scene: {} joint points and {} axes, expected two points at least "
                    "and an axis for each but the last",
                    points, pose.axis_directions.size()));
  }
  for (const auto& point : pose.joint_points) requireFinite(point, "a joint point");
  for (const auto& axis : pose.axis_directions) {
    requireFinite(axis, "an axis direction");
    if (axis.isZero()) throw std::invalid_argument("arm scene: an axis direction is zero");
  }
  for (const ScenePoint& target : pose.targets) requireFinite(target);
  if (pose.wrist) requireFinite(*pose.wrist);
  if (pose.load) {
    requireFinite(pose.load->at, "the place of the load");
    requireFinite(pose.load->force, "the force of the load");
  }
}

}  // namespace

void requireDrawable(const ArmScene& scene) {
  if (scene.poses.empty()) throw std::invalid_argument("arm scene: no pose");
  for (const ArmPose& pose : scene.poses) requireDrawable(pose);
  for (const SceneTrace& trace : scene.traces) {
    for (const auto& point : trace.points) requireFinite(point, fmt::format("a point of '{}'", trace.label));
  }
  for (const auto& point : scene.also_fitted) requireFinite(point, "a point that is to fit");
  if (scene.magnification) requirePositive(*scene.magnification, "magnification");
  requirePositive(scene.residual_factor, "residual factor");
  if (scene.picked) requireFinite(*scene.picked, "the picked point");
  if (scene.framing) {
    requireFinite(scene.framing->centre, "the centre of the framing");
    requirePositive(scene.framing->metres_high, "height of the framing");
  }
  if (scene.view_direction) {
    requireFinite(*scene.view_direction, "the view direction");
    if (scene.view_direction->isZero()) throw std::invalid_argument("arm scene: the view direction is zero");
  }
}

namespace {

constexpr std::size_t kGhosts = 1, kArms = 2, kVectors = 3, kFront = 6;

Projection projectionIn(const Box& room, const ArmScene& scene, double unit, double magnification) {
  const ViewAxes axes = viewAxesOf(scene);
  Eigen::Matrix3d base_to_view;
  base_to_view << axes.right.transpose(), axes.up.transpose(), axes.to_viewer.transpose();
  Eigen::AlignedBox3d extent = extentOf(scene, magnification, base_to_view);
  if (scene.framing) return Projection(axes, extent, room, *scene.framing);
  const FloorGrid floor = floorOf(scene);
  for (const int x : {floor.x_first, floor.x_last}) {
    // With others of a series, the floor may go on behind the words; what stands on it is what matters.
    for (const int y : {floor.y_first, floor.y_last}) {
      if (scene.also_fitted.empty()) extent.extend(base_to_view * floor.at(x, y));
    }
  }
  // Labels stand outside of the outermost points.
  const double beside = 36 * unit, above = 10 * unit;
  const Box inner{room.left + beside, room.top + above, room.right - beside, room.bottom - above};
  return Projection(axes, extent, inner);
}

}  // namespace

ArmLayers::ArmLayers(ArmScene scene, const Surface& surface)
    : scene_(std::move(scene)), surface_(surface), layers_(kFront + 1) {
  requireDrawable(scene_);
  surface_.palette = paletteOf(scene_);
  const Colour paper = surface_.palette.paper;
  for (auto& layer : layers_) {
    layer = vtkSmartPointer<vtkRenderer>::New();
    layer->SetBackground(paper.red / 255.0, paper.green / 255.0, paper.blue / 255.0);
  }
  // How much room titles leave is known once they are measured, which takes a canvas; so the painting of the
  // back layer, which VTK renders first, sets up the layers before it.
  paintings_.emplace_back(*layers_.front(), surface_, [this](Canvas& canvas) { paintBack(canvas); });
  paintings_.emplace_back(*layers_.back(), surface_, [this](Canvas& canvas) {
    if (stage_) paintFront(canvas);
  });
}

void ArmLayers::paintFront(Canvas& canvas) {
  paintLabels(canvas, *stage_);
  if (!scene_.framing && scene_.also_fitted.empty()) return;
  // What was drawn may reach out of its room: paper over it, and the words once more.
  const Box all = canvas.all(), room = stage_->room;
  const Colour paper = surface_.palette.paper;
  canvas.fill({all.left, all.top, all.right, room.top}, paper);
  canvas.fill({all.left, room.bottom, all.right, all.bottom}, paper);
  canvas.fill({all.left, room.top, room.left, room.bottom}, paper);
  canvas.fill({room.right, room.top, all.right, room.bottom}, paper);
  paintScale(canvas, *stage_, paintSurroundings(canvas, scene_).strip);
}

void ArmLayers::paintBack(Canvas& canvas) {
  const SceneLayout layout = paintSurroundings(canvas, scene_);
  if (!stage_) addSolids(layout.room, canvas.unit());
  paintFloor(canvas, *stage_);
  paintScale(canvas, *stage_, layout.strip);
}

void ArmLayers::addSolids(const Box& room, double unit) {
  const double magnification = scene_.magnification.value_or(automaticMagnification(scene_));
  stage_ = std::make_unique<SceneStage>(SceneStage{scene_, surface_, unit, magnification, viewAxesOf(scene_), room,
                                                   projectionIn(room, scene_, unit, magnification)});
  addArmsTo(*layers_[kGhosts], *stage_, true);
  addArmsTo(*layers_[kArms], *stage_, false);
  const auto kinds = vectorKinds(scene_);
  for (std::size_t i = 0; i < kinds.size(); ++i) addVectorsTo(*layers_[kVectors + i], *stage_, kinds[i]);
  addDotsTo(*layers_[kFront], *stage_);
}

void ArmLayers::rethrow() const {
  for (const Painting& painting : paintings_) painting.rethrow();
}

}  // namespace stiffscope::render
