#include "render/vtk/arm_shape.h"

#include <algorithm>
#include <cmath>

#include "render/ticks.h"
#include "render/vtk/marks.h"

namespace stiffscope {

ArmProportions::ArmProportions(const ArmPose& pose) {
  for (std::size_t i = 1; i < pose.joint_points.size(); ++i) {
    length += (pose.joint_points[i] - pose.joint_points[i - 1]).norm();
  }
  base_radius = 0.042 * length;
  tip_radius = 0.018 * length;
  target_radius = 0.6 * tip_radius;
}

namespace {

struct Paint {
  Colour link, joint, target;
};

void addPedestal(Mesh& mesh, const Eigen::Vector3d& first_joint, double radius, Colour colour) {
  const Eigen::Vector3d foot(first_joint.x(), first_joint.y(), std::min(0.0, first_joint.z()));
  const Eigen::Vector3d plate = foot + Eigen::Vector3d(0, 0, 0.35 * radius);
  mesh.addCone(foot, 2.1 * radius, plate, 2.1 * radius, colour);
  if (first_joint.z() > plate.z()) mesh.addCone(plate, 1.7 * radius, first_joint, 1.5 * radius, colour);
}

void addDrum(Mesh& mesh, const Eigen::Vector3d& joint, const Eigen::Vector3d& axis, double radius,
             Colour colour) {
  const Eigen::Vector3d half = 1.35 * radius * axis.normalized();
  mesh.addCone(joint - half, 1.28 * radius, joint + half, 1.28 * radius, colour);
}

// The waist stands upon the pedestal: up the first axis as far as the shoulder, then across to it.
void addWaist(Mesh& mesh, const ArmPose& pose, double radius, double next, const Paint& paint) {
  const Eigen::Vector3d& foot = pose.joint_points[0];
  const Eigen::Vector3d& shoulder = pose.joint_points[1];
  const Eigen::Vector3d axis = pose.axis_directions[0].normalized();
  const Eigen::Vector3d corner = foot + axis.dot(shoulder - foot) * axis;
  mesh.addCone(foot, 1.45 * radius, foot + std::min(0.25, 0.6 * radius) * axis, 1.45 * radius, paint.joint);
  mesh.addCone(foot, 1.2 * radius, corner, 1.05 * radius, paint.link);
  mesh.addSphere(corner, 1.05 * radius, paint.link);
  mesh.addCone(corner, 1.05 * radius, shoulder, next, paint.link);
}

void addFlange(Mesh& mesh, const ArmPose& pose, const ArmProportions& proportions, const Paint& paint) {
  const double radius = proportions.tip_radius;
  const Eigen::Vector3d& flange = pose.joint_points.back();
  const Eigen::Vector3d axis = pose.axis_directions.back().normalized();
  // It faces away from the arm, whichever way its axis was counted.
  const double side = axis.dot(flange - pose.joint_points[pose.joint_points.size() - 2]) < 0 ? -1 : 1;
  mesh.addCone(flange - 0.6 * side * radius * axis, 1.7 * radius, flange, 1.7 * radius, paint.joint);
  for (const ScenePoint& target : pose.targets) {
    mesh.addCone(flange, 0.25 * radius, target.position, 0.25 * radius, paint.joint);
    mesh.addSphere(target.position, proportions.target_radius, paint.target);
  }
}

}  // namespace

double ArmProportions::radiusAt(double along) const {
  return std::lerp(base_radius, tip_radius, length > 0 ? along / length : 0);
}

void addArm(Mesh& mesh, const ArmPose& pose, const Palette& palette) {
  const ArmProportions proportions(pose);
  const double faint = pose.ghost ? 0.4 : 1;
  const Paint paint{paler(palette.link, faint, palette.paper), paler(palette.joint, faint, palette.paper),
                    paler(palette.target, faint, palette.paper)};
  const auto& points = pose.joint_points;
  addPedestal(mesh, points.front(), proportions.base_radius, paint.joint);
  double along = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double radius = proportions.radiusAt(along);
    along += (points[i + 1] - points[i]).norm();
    const double next = proportions.radiusAt(along);
    if (i == 0) {
      addWaist(mesh, pose, radius, next, paint);
      continue;
    }
    addDrum(mesh, points[i], pose.axis_directions[i], radius, paint.joint);
    mesh.addCone(points[i], radius, points[i + 1], next, paint.link);
  }
  addFlange(mesh, pose, proportions, paint);
}

Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification,
                             const Eigen::Matrix3d& base_to_view) {
  Eigen::AlignedBox3d box;
  const auto include = [&](const Eigen::Vector3d& point, double around) {
    const Eigen::Vector3d p = base_to_view * point;
    box.extend(p - Eigen::Vector3d::Constant(around));
    box.extend(p + Eigen::Vector3d::Constant(around));
  };
  for (const ArmPose& pose : scene.poses) {
    const ArmProportions proportions(pose);
    for (const auto& point : pose.joint_points) include(point, 1.8 * proportions.base_radius);
    const Eigen::Vector3d& first = pose.joint_points.front();
    include({first.x(), first.y(), std::min(0.0, first.z())}, 2.2 * proportions.base_radius);
  }
  const double around = ArmProportions(scene.poses.front()).tip_radius;
  for (const auto& point : pointsOf(scene, magnification)) include(point, around);
  for (const auto& point : scene.also_fitted) include(point, around);
  return box;
}

FloorGrid floorOf(const ArmScene& scene) {
  const Eigen::AlignedBox3d box = extentOf(scene, 0, Eigen::Matrix3d::Identity());
  const double step = std::max(0.5, roundUp125(box.sizes().head<2>().maxCoeff() / 12));
  const auto below = [step](double x) { return static_cast<int>(std::floor(x / step)); };
  const auto above = [step](double x) { return static_cast<int>(std::ceil(x / step)); };
  return {step, below(box.min().x()), above(box.max().x()), below(box.min().y()), above(box.max().y())};
}

}  // namespace stiffscope
