#include "render/arm_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/ticks.h"

namespace stiffscope {

double automaticMagnification(const ArmScene& scene) {
  Eigen::AlignedBox3d box;
  double longest = 0;
  const auto see = [&](const ScenePoint& point) {
    box.extend(point.position);
    if (point.measured) longest = std::max(longest, point.measured->norm());
    if (point.predicted) longest = std::max(longest, point.predicted->norm());
  };
  for (const ArmPose& pose : scene.poses) {
    for (const Eigen::Vector3d& joint : pose.joint_points) box.extend(joint);
    for (const ScenePoint& target : pose.targets) see(target);
    if (pose.wrist) see(*pose.wrist);
  }
  if (!(longest > 0) || box.isEmpty() || !(box.sizes().maxCoeff() > 0)) return 1;
  return roundDown125(box.sizes().maxCoeff() / 5 / longest);
}

}  // namespace stiffscope
