#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

namespace stiffscope::render {

/// A point with its displacement under load. Position and vectors in the base frame, m.
struct ScenePoint {
  std::string label;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> measured;
  std::optional<Eigen::Vector3d> predicted;
  std::optional<Eigen::Vector3d> residual = std::nullopt;  ///< measured - predicted
};

/// What pulls at the arm: an arrow in its direction, of one length whatever the force, for newtons have no scale beside
/// magnified millimetres.
struct SceneLoad {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();     ///< where it acts, base frame, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< base frame, N
  std::string label;
};

/// The arm in one posture. Points and directions in the base frame.
struct ArmPose {
  /// From the first joint to the flange, m; the flange is last. Points may coincide (a spherical wrist).
  std::vector<Eigen::Vector3d> joint_points;
  /// The axis of each joint, that is of every joint point but the last.
  std::vector<Eigen::Vector3d> axis_directions;
  std::vector<ScenePoint> targets;  ///< reflectors, drawn as small spheres
  std::optional<ScenePoint> wrist;  ///< the wrist centre, drawn as a larger one
  bool ghost = false;               ///< drawn pale, behind the others, without labels: one of several postures
  std::optional<SceneLoad> load = std::nullopt;  ///< not drawn of a ghost
};

/// Readings that belong together, drawn as dots over the arm: those of a circle sweep. Base frame, m.
struct SceneTrace {
  std::string label;  ///< beside the last of the points
  std::vector<Eigen::Vector3d> points;
  bool faint = false;  ///< one of those that are not the matter now
};

/// From where the scene is seen, in parallel projection. The base z axis points up, except from the top,
/// where y does.
enum class View {
  oblique,  ///< from above, between front and side: x to the right and towards the viewer, y away
  front,    ///< against x0: y to the right
  side,     ///< along y0: x to the right
  top       ///< against z0: x to the right, y up
};

/// Unit vector from the viewer into the scene.
Eigen::Vector3d directionOf(View view);

/// Which part of a scene is shown, where the picture is not to fit it by itself.
struct SceneFraming {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< stands in the middle of the room of the scene, m
  double metres_high = 1;                            ///< the height of that room
};

/// Lines of words in columns beside the scene: numbers of a point, or what keys do.
struct ScenePanel {
  struct Row {
    std::vector<std::string> cells;
    std::optional<Colour> mark;  ///< a patch of this colour before the row
  };
  std::string title;
  std::vector<Row> rows;
  bool numbers = false;  ///< the cells but the first are aligned at their right, else at their left
};

/// Deflection vectors on the arm, to scale in direction and magnified in length: the factor and a reference
/// arrow are printed on the picture. Arrows start at their point and are drawn over the arm, so none is
/// hidden. Floor: z = 0 of the base frame, with a grid of 0.5 m (or the step that fits). In every text
/// `x_{abc}` sets abc as a subscript.
struct ArmScene {
  std::string title;
  std::string subtitle;
  std::vector<ArmPose> poses;
  std::vector<SceneTrace> traces;
  std::optional<double> magnification;  ///< of all vectors; none: automaticMagnification
  double residual_factor = 1;           ///< residual vectors are drawn this many times longer than the others
  View view = View::oblique;
  std::optional<Eigen::Vector3d> view_direction;  ///< from the viewer into the scene, instead of `view`
  std::optional<SceneFraming> framing;            ///< none: all that is drawn fits the picture
  /// Points that fit the picture, too, and have floor under them: those of other scenes of a series, m. The
  /// floor's rim need not fit then.
  std::vector<Eigen::Vector3d> also_fitted;
  /// Where the frame x0, y0, z0 is drawn, its axes parallel to the base frame's, m.
  Eigen::Vector3d frame_origin = Eigen::Vector3d::Zero();
  std::string measured_name = "measured";
  std::string predicted_name = "predicted";
  std::string residual_name = "residual";
  std::string trace_name;                 ///< of the dots, for the legend
  std::vector<ScenePanel> panels;         ///< at the right, below each other, where they cover nothing
  std::optional<Eigen::Vector3d> picked;  ///< a ring around this point, m
  std::string note;                       ///< the lowest line
  bool dark = false;                      ///< on dark paper
};

/// The factor of the series 1-2-5 with which the longest vector of the scene is at most a fifth of the
/// largest side of the box around all its points; 1 when there is no vector that is not zero. Residual
/// vectors count with their factor.
double automaticMagnification(const ArmScene& scene);

/// The largest of 1, 2, 5, 10 .. 100 with which no residual vector is drawn longer than the longest of the
/// others; 1 when there are no others, or no residual ones.
double automaticResidualFactor(const ArmScene& scene);

/// All points that the scene draws, m: joints, targets, wrist centres, traces, and the tips of the vectors as
/// magnified.
std::vector<Eigen::Vector3d> pointsOf(const ArmScene& scene, double magnification);

/// Draws the scene. Throws std::invalid_argument when there is no pose, when a pose has fewer than two joint
/// points or not one axis a joint, when a number is not finite or a factor not positive, or when `size` is
/// too small; std::runtime_error when offscreen rendering is not to be had.
Image render(const ArmScene& scene, Size size = {1200, 800});

}  // namespace stiffscope::render
