#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/calibration/fitted_arm.h"
#include "core/calibration/unloaded_day.h"
#include "core/robot/robot.h"

namespace stiffscope::comparison {

/// What a number of the geometry is: of axis i + 1 against axis i, as calibration::LinkParameters has them.
enum class NumberKind {
  joint_zero,  ///< theta of axis i, rad
  along,       ///< d: how far along axis i axis i + 1 stands, m; not of axes that are parallel
  distance,    ///< a: between the two axes, m
  twist,       ///< alpha: angle between them, rad
  tilt,        ///< beta, of parallel axes: angle between them across that of alpha, rad
  // Of axes that are one line, how far axis i + 1 is off axis i: along x and y of Denavit and Hartenberg's frame on
  // axis i at zero, m, and the components of its direction, rad.
  off_x,
  off_y,
  tilt_x,
  tilt_y,
};

struct GeometryNumber {
  NumberKind kind = {};
  int axis = 1;   ///< i, from 1 to one before the last
  int joint = 0;  ///< of joint_zero, from 1: the joint that turns this axis and no other; 0: coupled joints turn it

  bool isLength() const {
    return kind == NumberKind::along || kind == NumberKind::distance || kind == NumberKind::off_x ||
           kind == NumberKind::off_y;
  }
};

/// The geometry of a machine in numbers that a day without a load sees whatever the base, the reflectors and the choice
/// of frames: Denavit and Hartenberg's (Hayati's where axes are parallel) from axis 1 to the last, without those of the
/// first link that turn and shift all along axis 1. The first are the base's (joint 1's zero looks like a base that is
/// turned), and the last joint's zero is the reflectors'.
///
/// Axes that are one line in the URDF to a millimetre and a milliradian (a parallelogram's elbow) have no common
/// perpendicular, and a zero of the one looks like a zero of the other: both zeros together are one number, that of the
/// outer axis.
class GeometryNumbers {
 public:
  explicit GeometryNumbers(const robot::Robot& nominal);

  const std::vector<GeometryNumber>& machine() const { return numbers_; }
  Eigen::Index count() const { return static_cast<Eigen::Index>(numbers_.size()); }

  Eigen::VectorXd of(const robot::Robot& arm) const;
  /// b - a, angles within half a turn.
  Eigen::VectorXd difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  /// All that two days are compared by: `of` the fitted arm, then reflectors (flange axes from the frame that the last
  /// two axes carry, m), then how base_link stands against `points_from_base`: rotation vector, shift.
  Eigen::VectorXd allOf(const robot::Robot& nominal, const calibration::ArmFit& fit, const std::vector<int>& targets,
                        const Eigen::Isometry3d& points_from_base) const;
  /// Where base_link stands in the readings' frame by a fit: its axis 1, and on it what link 1's first numbers say.
  Eigen::Isometry3d pointsFromBase(const robot::Robot& nominal, const calibration::ArmFit& fit) const;

  /// How the reflectors move by each number, m a unit, in every posture of `days` (as of `arm`, reflectors at zero),
  /// beyond what another base and other reflectors do: mean of the products of those columns, so that
  /// sqrt(d^T G d) is the rms of the 3-D positions by a change d.
  Eigen::MatrixXd movesOfReflectors(const robot::Robot& arm, const std::vector<Eigen::Vector3d>& targets_at_zero,
                                    const std::vector<const calibration::UnloadedDay*>& days) const;

  /// Number (from 1) of the axis before that is one line with this one; 0: none.
  int oneLineWith(int axis) const;

  /// How the numbers change by a small turn of a joint's zero (from 0), with all axes that it turns.
  Eigen::VectorXd byJoint(const robot::Robot& arm, int joint) const;
  /// How the numbers change by a small motion (rotation, then shift) of everything beyond axis i (but the last), by a
  /// small step of axis i alone (shifts and tilts across it), and by all lengths growing.
  Eigen::MatrixXd byLink(const robot::Robot& arm, int axis) const;
  Eigen::MatrixXd byAxis(const robot::Robot& arm, int axis) const;
  Eigen::VectorXd byGrowth(const robot::Robot& arm) const;

 private:
  int jointOfZero(int axis) const;

  robot::Robot nominal_;
  std::vector<GeometryNumber> numbers_;
};

}  // namespace stiffscope::comparison
