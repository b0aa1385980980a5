#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "render/arm_scene.h"
#include "render/vtk/mesh.h"

namespace stiffscope {

/// The sizes that make an arm of lines look like one, from its length.
struct ArmProportions {
  explicit ArmProportions(const ArmPose& pose);
  double length = 0;
  double base_radius = 0;
  double tip_radius = 0;
};

/// Pedestal, links, drums, flange, holders of the targets, targets and wrist centre of one posture.
void addArm(Mesh& mesh, const ArmPose& pose);

/// The box around all that is drawn of the scene but the floor, in the base frame turned by `base_to_view`
/// (rows: the view axes), m.
Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification,
                             const Eigen::Matrix3d& base_to_view);

}  // namespace stiffscope
