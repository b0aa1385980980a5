#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "render/arm_scene.h"
#include "render/vtk/mesh.h"

namespace stiffscope {

/// The sizes that make an arm of lines look like one, from its length.
struct ArmProportions {
  explicit ArmProportions(const ArmPose& pose);
  /// Of the links, `along` metres from the first joint.
  double radiusAt(double along) const;

  double length = 0;
  double base_radius = 0;
  double tip_radius = 0;
  double target_radius = 0;
};

/// Pedestal, links, drums, flange, holders of the targets, targets and wrist centre of one posture.
void addArm(Mesh& mesh, const ArmPose& pose, const Palette& palette);

/// The lines of the floor: multiples of `step` (m) from first to last, under all that is drawn.
struct FloorGrid {
  double step = 0.5;
  int x_first = 0, x_last = 0, y_first = 0, y_last = 0;
  Eigen::Vector3d at(int i, int j) const { return {i * step, j * step, 0}; }
};
FloorGrid floorOf(const ArmScene& scene);

/// The box around all that is drawn of the scene but the floor, in the base frame turned by `base_to_view`
/// (rows: the view axes), m.
Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification,
                             const Eigen::Matrix3d& base_to_view);

}  // namespace stiffscope
