#include "render/vtk/scene_stage.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <algorithm>

namespace stiffscope::render {

ViewAxes viewAxesOf(const ArmScene& scene) {
  const Eigen::Vector3d direction = scene.view_direction ? scene.view_direction->normalized() : directionOf(scene.view);
  const bool vertical = std::abs(direction.z()) > 0.999;
  const Eigen::Vector3d upwards = vertical ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = direction.cross(upwards).normalized();
  return {right, right.cross(direction), -direction};
}

Projection::Projection(const ViewAxes& axes, const Eigen::AlignedBox3d& extent, const Box& room)
    : axes_(axes),
      centre_in_view_(extent.center()),
      depth_(std::max(extent.sizes().norm(), 1e-3)),
      middle_{room.middleX(), room.middleY()},
      scale_(std::min(room.width() / std::max(extent.sizes().x(), 1e-3),
                      room.height() / std::max(extent.sizes().y(), 1e-3))) {}

Projection::Projection(const ViewAxes& axes, const Eigen::AlignedBox3d& extent, const Box& room,
                       const SceneFraming& framing)
    : Projection(axes, extent, room) {
  // The depth stays that of the scene, so that nothing is clipped.
  const Eigen::Vector3d centre = axes.inView(framing.centre);
  centre_in_view_.head<2>() = centre.head<2>();
  scale_ = room.height() / framing.metres_high;
}

SceneFraming Projection::framingOf(const Box& room) const {
  return {axes_.right * centre_in_view_.x() + axes_.up * centre_in_view_.y() + axes_.to_viewer * centre_in_view_.z(),
          room.height() / scale_};
}

Spot Projection::spotOf(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d offset = axes_.inView(point) - centre_in_view_;
  return {middle_.x + scale_ * offset.x(), middle_.y - scale_ * offset.y()};
}

void Projection::setCamera(vtkRenderer& layer, Size size) const {
  // The camera looks at what lies in the middle of the whole picture, not of the room.
  Eigen::Vector3d focus_in_view = centre_in_view_;
  focus_in_view.x() += (size.width / 2.0 - middle_.x) / scale_;
  focus_in_view.y() -= (size.height / 2.0 - middle_.y) / scale_;
  const Eigen::Vector3d focus =
      axes_.right * focus_in_view.x() + axes_.up * focus_in_view.y() + axes_.to_viewer * focus_in_view.z();
  const Eigen::Vector3d eye = focus + 2 * depth_ * axes_.to_viewer;
  vtkCamera* camera = layer.GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(focus.data());
  camera->SetPosition(eye.data());
  camera->SetViewUp(axes_.up.data());
  camera->SetParallelScale(size.height / 2.0 / scale_);
  camera->SetClippingRange(0.1 * depth_, 4 * depth_);
}

}  // namespace stiffscope::render
