#pragma once

#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <memory>

#include "core/robot/kinematics.h"
#include "metrology/lines.h"

namespace stiffscope::frames {

/// Everything that places an arm and its reflectors against the readings, as steps from a geometry; m and rad, in R0.
/// Of n axes:
///   4 j + 0..3        axis j = 0..n-1 at zero joint angles: shift_u, shift_v, tilt_u, tilt_v, as MeasuredLine has them
///   baseAt() + 0..5   the readings against the base: rotation vector r about `centre`, then shift s
///   targetAt(t) + 0.. reflector t at zero joint angles: x, y, z
/// At joint angles q (rad), reflector t, which stands at x_t at zero, is seen at
///   p = B exp(xi_1 theta_1) ... exp(xi_n theta_n) x_t,   B^-1 y = exp([r]) (y - centre) + centre + s,
/// xi_j the axes as moved, theta their angles (q, but for coupled joints). Six combinations are free by choice of
/// frame: fits hold them by a prior, or fix as many parameters.
class ArmParameters {
 public:
  static constexpr Eigen::Index kOfAxis = 4, kBase = 6, kOfMostAxes = kOfAxis * kMostJoints;
  /// For differences of what is more than positions: far above rounding, far below where the model curves.
  static constexpr double kSmall = 1e-6;

  constexpr explicit ArmParameters(int axes) : axes_(kOfAxis * axes) {}

  constexpr Eigen::Index axes() const { return axes_; }  ///< how many are of the axes
  constexpr Eigen::Index baseAt() const { return axes_; }
  constexpr Eigen::Index targetsAt() const { return axes_ + kBase; }
  constexpr Eigen::Index targetAt(std::size_t target) const {
    return targetsAt() + 3 * static_cast<Eigen::Index>(target);
  }
  constexpr Eigen::Index count(std::size_t targets) const { return targetAt(targets); }

 private:
  Eigen::Index axes_;
};
/// Those of the axes alone, and the displacement of a point by each of them.
using AxesSteps = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, ArmParameters::kOfMostAxes, 1>;
using PointByAxes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, ArmParameters::kOfMostAxes>;

/// The axes from which steps are taken: at zero, in R0, each with its two directions across.
struct AxesAtStart : PerJoint<metrology::MeasuredLine> {
  using PerJoint<metrology::MeasuredLine>::PerJoint;

  std::shared_ptr<const robot::Couplings> couplings;  ///< of the joints that turn them, as robot::ArmAxes has them
};

/// Directions across by metrology::basisAcross, no covariance: what `moved` takes.
AxesAtStart axesAtStart(const robot::ArmAxes& axes);

/// A small motion: rotation vector, and shift of what stands at the origin.
struct SmallMotion {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();

  Eigen::Vector3d at(const Eigen::Vector3d& point) const { return rotation.cross(point) + shift; }
};

/// One a parameter of the axes.
using SmallMotions = boost::container::static_vector<SmallMotion, ArmParameters::kOfMostAxes>;

/// Axes and base at some values of their parameters: what all postures have in common.
struct PlacedArm {
  robot::ArmAxes axes;
  SmallMotions steps;  ///< of the axis itself, by a small change of its parameter
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d centre;
  Eigen::Matrix3d turn_by_rotation = Eigen::Matrix3d::Identity();  ///< turn of the base by a small change of r

  /// With all parameters zero.
  explicit PlacedArm(const AxesAtStart& start, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero());
  PlacedArm(const AxesAtStart& start, const Eigen::Vector3d& centre, const AxesSteps& axes_by, const Vector6d& base_by);

  /// Motion of everything that is seen by a small change of base parameter k: it moves against the readings' frame.
  SmallMotion byBase(std::size_t k) const;
};

/// One posture of it, computed once for all of its reflectors. Exact derivatives: in a product of exponentials, moving
/// axis j by a small motion xi moves what is beyond it by M_{j-1} xi M_{j-1}^-1 - M_j xi M_j^-1, M_b the motion of body
/// b from its place at zero, M_0 = B. Keeps a reference to the arm.
class PlacedPosture {
 public:
  PlacedPosture(const PlacedArm& arm, const JointVector& q)
      : PlacedPosture(arm, robot::postureAt(arm.axes, q, arm.base)) {}
  /// A posture that was computed before, of the arm and base as placed.
  PlacedPosture(const PlacedArm& arm, const robot::ArmPosture& posture);

  Eigen::Vector3d position(const Eigen::Vector3d& at_zero) const { return posture_.motion.back() * at_zero; }

  // Derivatives of a point of the flange that is at `position` now.
  PointByAxes byAxes(const Eigen::Vector3d& position) const;
  Eigen::Matrix<double, 3, ArmParameters::kBase> byBase(const Eigen::Vector3d& position) const;
  Eigen::Matrix3d byTarget() const { return posture_.motion.back().linear(); }
  PointJacobian byAngles(const Eigen::Vector3d& position) const;
  /// Motion of the flange by a small turn of joint j.
  SmallMotion byJoint(std::size_t j) const;
  /// How body b (0: the base; the last: the flange) stands turned from where it is at zero.
  Eigen::Matrix3d turnOf(std::size_t body) const { return posture_.motion[body].linear(); }

  /// By a small change of axis parameter k: the axis of joint k / 4, and all that this joint carries.
  const SmallMotion& ofAxis(std::size_t k) const { return of_axis_[k]; }
  const SmallMotion& beyondAxis(std::size_t k) const { return beyond_[k]; }

 private:
  const PlacedArm& arm_;
  robot::ArmPosture posture_;
  SmallMotions of_axis_, beyond_;
};

}  // namespace stiffscope::frames
