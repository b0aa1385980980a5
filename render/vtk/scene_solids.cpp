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
  stage.projection.setCamera(layer, stage.surface.size);
  layer.AddActor(mesh.actor());
}

}  // namespace

void addArmsTo(vtkRenderer& layer, const SceneStage& stage, bool ghosts) {
  Mesh mesh(lightOf(stage.axes), ghosts ? kFlatAmbient : kArmAmbient);
  for (const ArmPose& pose : stage.scene.poses) {
    if (pose.ghost == ghosts) addArm(mesh, pose, stage.surface.palette);
  }
  show(layer, stage, mesh);
}

void addVectorsTo(vtkRenderer& layer, const SceneStage& stage, const VectorKind& kind) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const double metres = stage.unit / stage.projection.pixelsPerMetre();
  const double factor = stage.magnification * kind.factor;
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    if (!(point.*kind.vector)) return;
    const Eigen::Vector3d tip = point.position + factor * *(point.*kind.vector);
    mesh.addArrow(point.position, tip, kind.width / 2 * metres, kHeadLength * metres, kind.colour);
  });
  show(layer, stage, mesh);
}

void addDotsTo(vtkRenderer& layer, const SceneStage& stage) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const Palette& palette = stage.surface.palette;
  const double metres = stage.unit / stage.projection.pixelsPerMetre();
  for (const ArmPose& pose : stage.scene.poses) {
    if (!pose.wrist) continue;
    mesh.addSphere(pose.wrist->position, 6 * metres,
                   paler(palette.wrist, pose.ghost ? 0.6 : 1, palette.paper));
  }
  for (const SceneTrace& trace : stage.scene.traces) {
    const Colour colour = paler(palette.measured, trace.faint ? 0.35 : 1, palette.paper);
    for (const auto& point : trace.points) mesh.addDot(point, (trace.faint ? 3 : 4) * metres, colour);
  }
  show(layer, stage, mesh);
}

}  // namespace stiffscope
