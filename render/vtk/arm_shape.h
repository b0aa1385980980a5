#pragma once

#include <vtkSmartPointer.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "render/arm_scene.h"
#include "render/colours.h"

class vtkActor;

namespace stiffscope::render {

/// Solids of revolution gathered into one surface, so that an arm is one draw call. The light is part of the
/// vertex colours: it comes from `light` (unit vector towards it), whatever the renderer has;
/// `ambient` (0 to 1) is the share of it that reaches every side.
class Mesh {
 public:
  Mesh(const Eigen::Vector3d& light, double ambient) : light_(light), ambient_(ambient) {}

  /// From the circle of radius `from_radius` at `from` to that at `to`, closed at both ends. Nothing when
  /// they coincide.
  void addCone(const Eigen::Vector3d& from, double from_radius, const Eigen::Vector3d& to, double to_radius,
               Colour colour);
  void addSphere(const Eigen::Vector3d& centre, double radius, Colour colour);
  /// A sphere so small that few corners do: there may be thousands.
  void addDot(const Eigen::Vector3d& centre, double radius, Colour colour);
  /// From `from` to `to`; the head takes `head_length` of it, or 60 % where the arrow is short, and
  /// is thinner then.
  void addArrow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, double head_length,
                Colour colour);

  vtkSmartPointer<vtkActor> actor() const;

 private:
  int addVertex(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, Colour colour);
  void addQuad(int a, int b, int c, int d);
  void addSphere(const Eigen::Vector3d& centre, double radius, Colour colour, int sides);

  Eigen::Vector3d light_;
  double ambient_;
  std::vector<float> points_;
  std::vector<std::uint8_t> colours_;
  std::vector<int> triangles_;
};

/// The sizes that make an arm of lines look like one, from its length.
struct ArmProportions {
  explicit ArmProportions(const ArmPose& pose);
  /// Radius of the links `along` metres from the first joint.
  double radiusAt(double along) const;

  double length = 0;
  double base_radius = 0;
  double tip_radius = 0;
  double target_radius = 0;
};

/// Where the arrow of the pose's load ends: 0.15 of the arm's length from where the load acts. Needs a load with a
/// force.
Eigen::Vector3d loadTip(const ArmPose& pose);
bool drawsLoad(const ArmPose& pose);

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
Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification, const Eigen::Matrix3d& base_to_view);

}  // namespace stiffscope::render
