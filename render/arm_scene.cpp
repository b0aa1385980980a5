#include "render/arm_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/ticks.h"

namespace stiffscope::render {

namespace {

template <typename Visit>
void forEachPoint(const ArmScene& scene, const Visit& visit) {
  for (const ArmPose& pose : scene.poses) {
    for (const ScenePoint& target : pose.targets) visit(target);
    if (pose.wrist) visit(*pose.wrist);
  }
}

double lengthOf(const std::optional<Eigen::Vector3d>& vector) { return vector ? vector->norm() : 0.0; }

struct Longest {
  double vector = 0;  ///< measured or predicted
  double residual = 0;
};

Longest longestOf(const ArmScene& scene) {
  Longest longest;
  forEachPoint(scene, [&](const ScenePoint& point) {
    longest.vector = std::max({longest.vector, lengthOf(point.measured), lengthOf(point.predicted)});
    longest.residual = std::max(longest.residual, lengthOf(point.residual));
  });
  return longest;
}

}  // namespace

Eigen::Vector3d directionOf(View view) {
  switch (view) {
    case View::front:
      return {-1, 0, 0};
    case View::side:
      return {0, 1, 0};
    case View::top:
      return {0, 0, -1};
    case View::oblique:
      break;
  }
  return Eigen::Vector3d(-0.5, 0.85, -0.42).normalized();
}

std::vector<Eigen::Vector3d> pointsOf(const ArmScene& scene, double magnification) {
  std::vector<Eigen::Vector3d> points;
  for (const ArmPose& pose : scene.poses) {
    points.insert(points.end(), pose.joint_points.begin(), pose.joint_points.end());
  }
  for (const SceneTrace& trace : scene.traces) {
    points.insert(points.end(), trace.points.begin(), trace.points.end());
  }
  forEachPoint(scene, [&](const ScenePoint& point) {
    const auto addTip = [&](const std::optional<Eigen::Vector3d>& vector, double factor) {
      if (vector) points.push_back(point.position + factor * *vector);
    };
    points.push_back(point.position);
    addTip(point.measured, magnification);
    addTip(point.predicted, magnification);
    addTip(point.residual, magnification * scene.residual_factor);
  });
  return points;
}

double automaticMagnification(const ArmScene& scene) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : pointsOf(scene, 0)) box.extend(point);
  const Longest found = longestOf(scene);
  const double longest = std::max(found.vector, scene.residual_factor * found.residual);
  if (!(longest > 0) || box.isEmpty() || !(box.sizes().maxCoeff() > 0)) return 1;
  return roundDown125(box.sizes().maxCoeff() / 5 / longest);
}

double automaticResidualFactor(const ArmScene& scene) {
  const Longest longest = longestOf(scene);
  if (!(longest.residual > 0) || !(longest.vector > longest.residual)) return 1;
  return std::min(100.0, roundDown125(longest.vector / longest.residual));
}

}  // namespace stiffscope::render
