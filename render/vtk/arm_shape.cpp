#include "render/vtk/arm_shape.h"

#include <algorithm>

#include "render/vtk/marks.h"

namespace stiffscope {

ArmProportions::ArmProportions(const ArmPose& pose) {
  for (std::size_t i = 1; i < pose.joint_points.size(); ++i) {
    length += (pose.joint_points[i] - pose.joint_points[i - 1]).norm();
  }
  base_radius = 0.042 * length;
  tip_radius = 0.018 * length;
}

namespace {

void addPedestal(Mesh& mesh, const Eigen::Vector3d& first_joint, double radius, Colour colour) {
  const Eigen::Vector3d foot(first_joint.x(), first_joint.y(), std::min(0.0, first_joint.z()));
  const Eigen::Vector3d plate = foot + Eigen::Vector3d(0, 0, 0.35 * radius);
  mesh.addCone(foot, 2.1 * radius, plate, 2.1 * radius, colour);
  if (first_joint.z() > plate.z()) mesh.addCone(plate, 1.7 * radius, first_joint, 1.3 * radius, colour);
}

}  // namespace

void addArm(Mesh& mesh, const ArmPose& pose) {
  const ArmProportions proportions(pose);
  const double faint = pose.ghost ? 0.35 : 1;
  const Colour link = paler(colours::kLink, faint), joint = paler(colours::kJoint, faint);
  const auto& points = pose.joint_points;
  addPedestal(mesh, points.front(), proportions.base_radius, joint);

  double along = 0;
  double radius = proportions.base_radius;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double step = (points[i + 1] - points[i]).norm();
    const double share = (along + step) / std::max(proportions.length, 1e-9);
    const double next = proportions.base_radius + share * (proportions.tip_radius - proportions.base_radius);
    const Eigen::Vector3d half = 1.35 * radius * pose.axis_directions[i].normalized();
    mesh.addCone(points[i] - half, 1.28 * radius, points[i] + half, 1.28 * radius, joint);
    mesh.addCone(points[i], radius, points[i + 1], next, link);
    along += step;
    radius = next;
  }
  const Eigen::Vector3d flange_axis = pose.axis_directions.back().normalized();
  const Eigen::Vector3d& flange = points.back();
  // The flange faces away from the arm, whichever way its axis was counted.
  const double side = flange_axis.dot(flange - points[points.size() - 2]) < 0 ? -1 : 1;
  mesh.addCone(flange - 0.6 * side * radius * flange_axis, 1.7 * radius, flange, 1.7 * radius, joint);

  for (const ScenePoint& target : pose.targets) {
    mesh.addCone(flange, 0.3 * radius, target.position, 0.3 * radius, joint);
    mesh.addSphere(target.position, 0.75 * radius, paler(colours::kTarget, faint));
  }
}

Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification,
                             const Eigen::Matrix3d& base_to_view) {
  Eigen::AlignedBox3d box;
  const auto include = [&](const Eigen::Vector3d& point, double around) {
    const Eigen::Vector3d p = base_to_view * point;
    box.extend(p - Eigen::Vector3d::Constant(around));
    box.extend(p + Eigen::Vector3d::Constant(around));
  };
  const auto includePoint = [&](const ScenePoint& point, double radius) {
    include(point.position, radius);
    if (point.measured) include(point.position + magnification * *point.measured, radius);
    if (point.predicted) include(point.position + magnification * *point.predicted, radius);
  };
  for (const ArmPose& pose : scene.poses) {
    const ArmProportions proportions(pose);
    for (const auto& point : pose.joint_points) include(point, 1.8 * proportions.base_radius);
    const Eigen::Vector3d& first = pose.joint_points.front();
    include({first.x(), first.y(), std::min(0.0, first.z())}, 2.2 * proportions.base_radius);
    for (const ScenePoint& target : pose.targets) includePoint(target, proportions.tip_radius);
    if (pose.wrist) includePoint(*pose.wrist, proportions.tip_radius);
  }
  return box;
}

}  // namespace stiffscope
