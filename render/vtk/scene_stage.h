#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>

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

inline constexpr double kMeasuredWidth = 6;     ///< pixels at 1200 x 700
inline constexpr double kPredictedWidth = 2.2;  ///< thinner and in front, so that both show where they agree
inline constexpr double kResidualWidth = 3.5;   ///< in front of both
/// Of a measured vector longer, so wider, than of one that is predicted: where both end at one place, a rim of the
/// measured one's head stays around that of the other.
inline constexpr double kMeasuredHead = 20, kPredictedHead = 10, kResidualHead = 15;

/// One kind of vector: which, how it is painted, and how it is called.
struct VectorKind {
  std::optional<Eigen::Vector3d> ScenePoint::*vector;
  Colour colour;
  double width;   ///< pixels at 1200 x 700
  double head;    ///< length of its head, the same
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
