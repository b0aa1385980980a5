#include "render/vtk/arm_picture.h"

#include <vtkRenderer.h>

#include <optional>

#include "render/vtk/arm_shape.h"
#include "render/vtk/flat_picture.h"
#include "render/vtk/offscreen_context.h"
#include "render/vtk/scene_check.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

namespace {

SceneStage stageIn(const Canvas& canvas, const ArmScene& scene, Size size, const Box& room) {
  const double magnification = scene.magnification.value_or(automaticMagnification(scene));
  const ViewAxes axes = viewAxesOf(scene);
  Eigen::Matrix3d base_to_view;
  base_to_view << axes.right.transpose(), axes.up.transpose(), axes.to_viewer.transpose();
  Eigen::AlignedBox3d extent = extentOf(scene, magnification, base_to_view);
  const FloorGrid floor = floorOf(scene);
  for (const int x : {floor.x_first, floor.x_last}) {
    for (const int y : {floor.y_first, floor.y_last}) extent.extend(base_to_view * floor.at(x, y));
  }
  // Labels stand outside of the outermost points.
  const double beside = 36 * canvas.unit(), above = 10 * canvas.unit();
  const Box inner{room.left + beside, room.top + above, room.right - beside, room.bottom - above};
  return {scene, size, canvas.unit(), magnification, axes, room, Projection(axes, extent, inner)};
}

}  // namespace

Image drawArmScene(const ArmScene& scene, Size size) {
  requireUsable(size);
  requireDrawable(scene);
  // From back to front: words and floor, ghosts, the arm, vectors thick and thin, wrist centres and labels.
  // Vectors are in front of the arm so that none is hidden, ghosts behind the posture that matters.
  std::vector<vtkSmartPointer<vtkRenderer>> layers(6);
  for (auto& layer : layers) {
    layer = vtkSmartPointer<vtkRenderer>::New();
    layer->SetBackground(1, 1, 1);
  }
  // How much room titles leave is known once they are measured, which takes a canvas; so the painting of the
  // back layer, which VTK renders first, sets up the layers before it.
  std::optional<SceneStage> stage;
  const Painting back(*layers[0], size, [&](Canvas& canvas) {
    const SceneLayout layout = paintSurroundings(canvas, scene);
    stage.emplace(stageIn(canvas, scene, size, layout.room));
    paintFloor(canvas, *stage);
    paintScale(canvas, *stage, layout.strip);
    addArmsTo(*layers[1], *stage, true);
    addArmsTo(*layers[2], *stage, false);
    addVectorsTo(*layers[3], *stage, &ScenePoint::measured, colours::kMeasured, kMeasuredWidth);
    addVectorsTo(*layers[4], *stage, &ScenePoint::predicted, colours::kPredicted, kPredictedWidth);
    addWristCentresTo(*layers[5], *stage);
  });
  const Painting front(*layers[5], size, [&](Canvas& canvas) {
    if (stage) paintLabels(canvas, *stage);
  });
  Image image = renderOffscreen(layers, size);
  back.rethrow();
  front.rethrow();
  return image;
}

}  // namespace stiffscope
