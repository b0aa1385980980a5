#pragma once

#include <Eigen/Geometry>
#include <array>

namespace stiffscope::simulation {

/// A straight spring between two bodies of the arm (0: the base, i: the body beyond joint i): from carousel
/// to upper arm a gravity compensator, along the forearm a dress pack. With l the distance of its ends and
/// l0 the same at all joints zero of the nominal arm, it pulls them together with
///   T(l) = tension + rate (l - l0),
/// negative where it pushes. Its torque on a joint follows from where its ends stand, hence from the posture.
struct LinkSpring {
  int from_body = 1, to_body = 2;
  Eigen::Vector3d from_in_base_at_zero = Eigen::Vector3d::Zero();  ///< m; must differ from `to`
  Eigen::Vector3d to_in_base_at_zero = Eigen::Vector3d::UnitZ();
  double rate = 0.0;     ///< N/m
  double tension = 0.0;  ///< N, at all joints zero
};

/// The spring with its bodies moved from their nominal places at zero.
struct SpringNow {
  Eigen::Vector3d from, to;  ///< its ends, base_link
  Eigen::Vector3d pull;      ///< N, on `from_body`; minus that on `to_body`
  double energy = 0.0;       ///< J, integral of T from l0 to l
};

SpringNow springNow(const LinkSpring& spring, const std::array<Eigen::Isometry3d, 7>& body_motions);

}  // namespace stiffscope::simulation
