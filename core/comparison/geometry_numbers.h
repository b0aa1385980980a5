#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/calibration/fitted_arm.h"
#include "core/calibration/unloaded_day.h"
#include "core/robot/robot.h"

namespace stiffscope::comparison {

/// What a number of the geometry is: of axis i + 1 against axis i, as calibration::LinkParameters has them.
enum class NumberKind {
  joint_zero,  ///< theta of joint i, rad
  along,       ///< d: how far along axis i axis i + 1 stands, m; not of axes that are parallel
  distance,    ///< a: between the two axes, m
  twist,       ///< alpha: angle between them, rad
  tilt,        ///< beta, of parallel axes: angle between them across that of alpha, rad
};

struct GeometryNumber {
  NumberKind kind = {};
  int axis = 1;  ///< i, from 1 to one before the last

  bool isLength() const { return kind == NumberKind::along || kind == NumberKind::distance; }
};

/// The geometry of a machine in numbers that a day without a load sees whatever the base, the reflectors and the choice
/// of frames: Denavit and Hartenberg's (Hayati's where axes are parallel) from axis 1 to the last, without those of the
/// first link that turn and shift all along axis 1. The first are the base's (joint 1's zero looks like a base that is
/// turned), and the last joint's zero is the reflectors'.
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

  /// How the numbers change by a small motion (rotation, then shift) of everything beyond axis i (but the last), by a
  /// small step of axis i alone (shifts and tilts across it), and by all lengths growing.
  Eigen::MatrixXd byLink(const robot::Robot& arm, int axis) const;
  Eigen::MatrixXd byAxis(const robot::Robot& arm, int axis) const;
  Eigen::VectorXd byGrowth(const robot::Robot& arm) const;

 private:
  robot::Robot nominal_;
  std::vector<GeometryNumber> numbers_;
};

}  // namespace stiffscope::comparison
