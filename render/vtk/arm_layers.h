#pragma once

#include <vtkSmartPointer.h>
#include <memory>
#include <vector>

#include "render/vtk/painting.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope::render {

/// The picture of an arm as layers of a render window, offscreen or on a display. From back to front: words
/// and floor, ghosts, the arm, the vectors, dots and labels. Vectors are in front of the arm so that none is
/// hidden, ghosts behind the posture that matters.
class ArmLayers {
 public:
  /// Throws std::invalid_argument as `render` does. `surface.palette` is that of the scene, whatever is
  /// given.
  ArmLayers(ArmScene scene, const Surface& surface);
  ArmLayers(const ArmLayers&) = delete;
  ArmLayers& operator=(const ArmLayers&) = delete;

  const std::vector<vtkSmartPointer<vtkRenderer>>& renderers() const { return layers_; }
  /// Once they are rendered: throws what the painting threw.
  void rethrow() const;
  /// Once they are rendered: how the scene was projected, and into which room.
  const SceneStage& stage() const { return *stage_; }

 private:
  void paintBack(Canvas& canvas);
  void paintFront(Canvas& canvas);
  void addSolids(const Box& room, double unit);

  ArmScene scene_;
  Surface surface_;
  std::vector<vtkSmartPointer<vtkRenderer>> layers_;
  std::unique_ptr<SceneStage> stage_;
  std::vector<Painting> paintings_;
};

}  // namespace stiffscope::render
