#include <vtkActor.h>
#include <vtkRenderer.h>

#include "render/vtk/arm_shape.h"
#include "render/vtk/marks.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

namespace {

// Vectors and ghosts are nearly flat: their colour is what counts.
constexpr double kArmAmbient = 0.55;
constexpr double kFlatAmbient = 0.86;

Eigen::Vector3d lightOf(const ViewAxes& axes) {
  return (-0.45 * axes.right + 0.65 * axes.up + 0.7 * axes.to_viewer).normalized();
}

void show(vtkRenderer& layer, const SceneStage& stage, const Mesh& mesh) {
  stage.projection.setCamera(layer, stage.size);
  layer.AddActor(mesh.actor());
}

}  // namespace

void addArmsTo(vtkRenderer& layer, const SceneStage& stage, bool ghosts) {
  Mesh mesh(lightOf(stage.axes), ghosts ? kFlatAmbient : kArmAmbient);
  for (const ArmPose& pose : stage.scene.poses) {
    if (pose.ghost == ghosts) addArm(mesh, pose);
  }
  show(layer, stage, mesh);
}

void addVectorsTo(vtkRenderer& layer, const SceneStage& stage, SceneVector vector, Colour colour,
                  double width) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const double metres = stage.unit / stage.projection.pixelsPerMetre();
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    if (!(point.*vector)) return;
    const Eigen::Vector3d tip = point.position + stage.magnification * *(point.*vector);
    mesh.addArrow(point.position, tip, width / 2 * metres, kHeadLength * metres, colour);
  });
  show(layer, stage, mesh);
}

void addWristCentresTo(vtkRenderer& layer, const SceneStage& stage) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const double radius = 6 * stage.unit / stage.projection.pixelsPerMetre();
  for (const ArmPose& pose : stage.scene.poses) {
    if (pose.wrist)
      mesh.addSphere(pose.wrist->position, radius, paler(colours::kWrist, pose.ghost ? 0.6 : 1));
  }
  show(layer, stage, mesh);
}

}  // namespace stiffscope
