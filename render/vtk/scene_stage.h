#pragma once

#include <array>
#include <optional>
#include <string>

#include "render/arm_scene.h"
#include "render/vtk/canvas.h"
#include "render/vtk/projection.h"

class vtkRenderer;

namespace stiffscope::render {

/// All that the layers of the picture of an arm have in common.
struct SceneStage {
  const ArmScene& scene;
  Surface surface;
  double unit;
  double magnification;
  ViewAxes axes;
  Box room;  ///< of the scene
  Projection projection;
};

inline constexpr double kMeasuredWidth = 5;     ///< pixels at 1200 x 700
inline constexpr double kPredictedWidth = 2.5;  ///< thinner and in front, so that both show where they agree
inline constexpr double kResidualWidth = 3.5;   ///< in front of both
inline constexpr double kHeadLength = 15;

/// One kind of vector: which, how it is painted, and how it is called.
struct VectorKind {
  std::optional<Eigen::Vector3d> ScenePoint::*vector;
  Colour colour;
  double width;   ///< pixels at 1200 x 700
  double factor;  ///< of its length, beside the magnification
  std::string name;
};
/// All kinds, from back to front.
std::array<VectorKind, 3> vectorKinds(const ArmScene& scene);
bool hasVectors(const ArmScene& scene, const VectorKind& kind);
const Palette& paletteOf(const ArmScene& scene);

template <typename Visit>
void forEachPoint(const ArmScene& scene, Visit visit) {
  for (const ArmPose& pose : scene.poses) {
    for (const ScenePoint& target : pose.targets) visit(target, pose);
    if (pose.wrist) visit(*pose.wrist, pose);
  }
}

/// The solids of the arms, ghosts or others; the arrows of one kind of vector; dots and wrist centres. Each
/// puts them and the camera into `layer`.
void addArmsTo(vtkRenderer& layer, const SceneStage& stage, bool ghosts);
void addVectorsTo(vtkRenderer& layer, const SceneStage& stage, const VectorKind& kind);
void addDotsTo(vtkRenderer& layer, const SceneStage& stage);

/// Title, legend, panels and note; what is left is the room of the scene and, below it, the strip of the
/// scale.
struct SceneLayout {
  Box room;
  Box strip;
};
SceneLayout paintSurroundings(Canvas& canvas, const ArmScene& scene);
/// The panels at the right of `free`, which loses their column.
void takePanels(Canvas& canvas, Box& free, const std::vector<ScenePanel>& panels);
void paintFloor(Canvas& canvas, const SceneStage& stage);
/// The reference arrow, drawn by the rule of the vectors, and the magnification in words; a second one of the
/// residual vectors, where those have a factor of their own.
void paintScale(Canvas& canvas, const SceneStage& stage, const Box& strip);
/// The base frame's axes, the labels of the points, the ring around the picked one.
void paintLabels(Canvas& canvas, const SceneStage& stage);

}  // namespace stiffscope::render
