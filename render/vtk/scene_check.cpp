#include "render/vtk/scene_check.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace stiffscope {

namespace {

void requireFinite(const Eigen::Vector3d& v, const std::string& what) {
  if (v.allFinite()) return;
  throw std::invalid_argument(
      fmt::format("arm scene: {} is ({}, {}, {}), expected finite numbers", what, v.x(), v.y(), v.z()));
}

void requireFinite(const ScenePoint& point) {
  requireFinite(point.position, fmt::format("the position of '{}'", point.label));
  if (point.measured) requireFinite(*point.measured, fmt::format("the measured vector of '{}'", point.label));
  if (point.predicted)
    requireFinite(*point.predicted, fmt::format("the predicted vector of '{}'", point.label));
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

}  // namespace stiffscope
