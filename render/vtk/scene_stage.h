#pragma once

#include "render/arm_scene.h"
#include "render/vtk/canvas.h"
#include "render/vtk/projection.h"

class vtkRenderer;

namespace stiffscope {

/// All that the layers of the picture of an arm have in common.
struct SceneStage {
  const ArmScene& scene;
  Size size;
  double unit;
  double magnification;
  ViewAxes axes;
  Box room;  ///< of the scene
  Projection projection;
};

inline constexpr double kMeasuredWidth = 5;     ///< pixels at 1200 x 700
inline constexpr double kPredictedWidth = 2.5;  ///< thinner and in front, so that both show where they agree
inline constexpr double kHeadLength = 15;

using SceneVector = std::optional<Eigen::Vector3d> ScenePoint::*;

template <typename Visit>
void forEachPoint(const ArmScene& scene, Visit visit) {
  for (const ArmPose& pose : scene.poses) {
    for (const ScenePoint& target : pose.targets) visit(target, pose);
    if (pose.wrist) visit(*pose.wrist, pose);
  }
}

/// The solids of the arms, ghosts or others, and the arrows of one kind of vector; each puts them and the
/// camera into `layer`.
void addArmsTo(vtkRenderer& layer, const SceneStage& stage, bool ghosts);
void addVectorsTo(vtkRenderer& layer, const SceneStage& stage, SceneVector vector, Colour colour,
                  double width);
void addWristCentresTo(vtkRenderer& layer, const SceneStage& stage);

/// Title and legend; what is left is the room of the scene and, below it, the strip of the scale.
struct SceneLayout {
  Box room;
  Box strip;
};
SceneLayout paintSurroundings(Canvas& canvas, const ArmScene& scene);
void paintFloor(Canvas& canvas, const SceneStage& stage);
/// The reference arrow, drawn by the rule of the vectors, and the magnification in words.
void paintScale(Canvas& canvas, const SceneStage& stage, const Box& strip);
/// The base frame's axes and the labels of the points.
void paintLabels(Canvas& canvas, const SceneStage& stage);

}  // namespace stiffscope
