#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "render/arm_scene.h"
#include "render/vtk/canvas.h"

class vtkRenderer;

namespace stiffscope::render {

/// A parallel projection: the directions that lie to the right and upwards on the picture, and out of it to
/// the viewer.
struct ViewAxes {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  Eigen::Vector3d to_viewer;

  /// x to the right, y up, z to the viewer.
  Eigen::Vector3d inView(const Eigen::Vector3d& v) const { return {right.dot(v), up.dot(v), to_viewer.dot(v)}; }
};
ViewAxes viewAxesOf(const ArmScene& scene);

/// A view, scaled and shifted so that `extent` (in view axes, m) fills `room` of a picture.
class Projection {
 public:
  Projection(const ViewAxes& axes, const Eigen::AlignedBox3d& extent_in_view, const Box& room);
  /// The same with scale and middle as `framing` wants them, whether all of `extent` is in the room or not.
  Projection(const ViewAxes& axes, const Eigen::AlignedBox3d& extent_in_view, const Box& room,
             const SceneFraming& framing);

  /// The framing that a picture with this room had to state to look the same.
  SceneFraming framingOf(const Box& room) const;

  double pixelsPerMetre() const { return scale_; }
  Spot spotOf(const Eigen::Vector3d& point) const;
  /// Gives `layer` a camera that projects as spotOf does, for a picture of `size`.
  void setCamera(vtkRenderer& layer, Size size) const;

 private:
  ViewAxes axes_;
  Eigen::Vector3d centre_in_view_;
  double depth_;
  Spot middle_;
  double scale_;
};

}  // namespace stiffscope::render
