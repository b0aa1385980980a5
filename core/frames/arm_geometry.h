#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/frames/frames.h"
#include "metrology/lines.h"

namespace stiffscope::frames {

/// The six swept axes in R0, each with the covariance of its four parameters, and the arm with one of these
/// moved: how a model's prediction hangs on what the sweeps leave open. Only meant for axes that were
/// measured.
class MovedAxes {
 public:
  explicit MovedAxes(const Frames& frames);

  /// 4x4, of axis `axis` (0-based).
  const Eigen::Matrix4d& covariance(std::size_t axis) const { return axes_[axis].covariance; }

  /// Posture of `arm` at `q` with parameter 0..3 of an axis moved by kStep.
  robot::ArmPosture postureWithMoved(const robot::Robot& arm, const Vector6d& q, std::size_t axis, int parameter) const;

  static constexpr double kStep = 1e-6;  ///< m and rad: far above rounding, far below where the model curves

 private:
  std::array<metrology::MeasuredLine, 6> axes_;
};

/// What a method takes as the geometry of the loaded arm, all in its base frame (R0): the arm, where the
/// reflectors stand on it, how the loading's readings come into it, and the stiffnesses by which its own
/// weight bends it.
struct LoadingGeometry {
  robot::Robot arm;
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
  std::optional<Eigen::Isometry3d> r0_from_loading;    ///< empty: absolute points of the loading cannot be used
  std::optional<Eigen::Matrix3d> displacements_in_r0;  ///< turns the `displacements` table's vectors into R0
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();
  robot::GravityLoad weight;
  Vector6d compliance = Vector6d::Zero();  ///< for the own weight's sag, rad/Nm; zero: rigid

  /// Joint angles with the sag in.
  Vector6d sagged(const Vector6d& q) const { return robot::saggedAngles(arm, q, weight, compliance); }
};

/// The geometry as the sweeps give it, for Complete Pose and Decoupled Partial Pose.
LoadingGeometry sweptGeometry(const campaign::Campaign& campaign, const Frames& frames, const Vector6d& compliance);

/// Small steps of everything that places the arm: per axis shift_u, shift_v (m), tilt_u, tilt_v (rad); a
/// rigid motion of all readings (rotation vector about `centre`, then shift); each reflector's place at zero
/// (m). Free by choice of frame in part: fits hold them by a wide prior.
struct GeometrySteps {
  static constexpr Eigen::Index kAxes = 24, kBase = 6;
  /// For differences, m and rad: far above rounding, far below where the model curves.
  static constexpr double kSmall = 1e-6;
  static Eigen::Index count(std::size_t targets) { return kAxes + kBase + 3 * static_cast<Eigen::Index>(targets); }
};

/// The geometry moved by such steps. The flange, and what is fixed to it, follows axes 5 and 6 (see ArmInR0).
LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps, const Eigen::Vector3d& centre);

}  // namespace stiffscope::frames
