#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "core/robot/robot.h"

namespace stiffscope::calibration {

/// From the frame on axis i to that on axis i + 1, z of each along its axis; m and rad.
///   axes that are not parallel:  Rz(theta + q_i) Tz(d) Tx(a) Rx(alpha)           (Denavit and Hartenberg 1955)
///   axes within a degree of it:  Rz(theta + q_i) Tx(a) Rx(alpha) Ry(beta)        (Hayati 1983; d = 0)
/// since the common perpendicular of axes that are nearly parallel stands anywhere along them.
struct LinkParameters {
  bool hayati = false;
  double theta = 0.0, d = 0.0, a = 0.0, alpha = 0.0, beta = 0.0;

  Eigen::Isometry3d at(double q) const;
};

/// An arm by Denavit and Hartenberg's parameters:
///   base_from_flange(q) = base_from_first * A_1(q_1) ... A_n-1(q_n-1) * Rz(q_n) * last_from_flange,
/// q_i the angles of the axes (those of the joints, but for coupled joints).
struct DenavitHartenberg {
  Eigen::Isometry3d base_from_first = Eigen::Isometry3d::Identity();
  PerJoint<LinkParameters> links;  ///< from axis to axis: one fewer than axes
  Eigen::Isometry3d last_from_flange = Eigen::Isometry3d::Identity();
  std::shared_ptr<const robot::Couplings> couplings;  ///< of the arm's joints, where they have any

  Eigen::Isometry3d flangeAt(const JointVector& q) const;
};

/// Parameters of an arm. Where a common perpendicular can point either way it points as the URDF's arm `nominal` has
/// it, and axes are as near to parallel as those of `nominal`, so that the two can be compared line by line.
DenavitHartenberg denavitHartenberg(const robot::Robot& arm, const robot::Robot& nominal);

/// Uncertainties of link parameters by a difference quotient (linkUncertainties), with 0 for what is its rounding
/// alone: below a millionth of the largest of lengths, or of angles. Such a parameter is fixed, held or a choice of
/// frame.
PerJoint<LinkParameters> withoutRounding(PerJoint<LinkParameters> uncertainties);

}  // namespace stiffscope::calibration
