#pragma once

#include <Eigen/Core>

#include "metrology/line.h"

namespace stiffscope {

/// A measured line with its uncertainty. The four degrees of freedom of a line are taken at `line.point`:
/// shifts along `across_u` and `across_v` (m), then tilts of the direction towards them (rad).
/// `covariance` is that of (shift_u, shift_v, tilt_u, tilt_v).
struct MeasuredLine {
  Line line;
  Eigen::Vector3d across_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d across_v = Eigen::Vector3d::UnitY();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  /// The line moved by a small step of its four parameters.
  Line moved(const Eigen::Vector4d& step) const;

  /// The same line directed the other way: its tilts change their sign, so that their covariance with the shifts does.
  MeasuredLine reversed() const;

  /// The four parameters that bring the line onto another nearby, whichever way that one is directed: what `moved`
  /// undoes.
  Eigen::Vector4d stepTo(const Line& other) const;
};

/// Two unit vectors that make a right-handed frame (u, v, direction).
void basisAcross(const Eigen::Vector3d& direction, Eigen::Vector3d& u, Eigen::Vector3d& v);

}  // namespace stiffscope
