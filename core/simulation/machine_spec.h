#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"

// The described machine: how it gives, how its geometry and masses differ from nominal. SI and radians.

namespace stiffscope::simulation {

/// How one joint gives. Absent: it does not.
struct JointStiffness {
  std::optional<double> torsion;  ///< about its axis, Nm/rad
  std::optional<double> bearing;  ///< about each direction across its axis, at the axis's point, Nm/rad
};

/// A link as a uniform straight beam from the point of joint `joint` to that of the next one (after the last:
/// to the flange). Absent: rigid in that respect.
struct LinkBeam {
  int joint = 0;                  ///< 0..5
  std::optional<double> bending;  ///< E I, the same in both planes, Nm^2
  std::optional<double> torsion;  ///< G J, Nm^2
  std::optional<double> shear;    ///< kappa G A, N; absent: Euler-Bernoulli, present: Timoshenko
  std::optional<double> axial;    ///< E A, N
};

/// How joint frame i, and all that it carries, differs from nominal: moved by `offset`, turned by the
/// rotation vector `tilt`, base_link axes at all joints zero; and the motor stands at `zero` + the reported
/// angle. The tilt pivots on the axis's point; for axes 4-6 of a wrist whose nominal axes meet, on that
/// meeting point.
struct AxisError {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();    ///< rad
  double zero = 0.0;                                 ///< rad
};

/// Listed errors stand as they are; the other axes' are drawn: offset and tilt in the two directions across
/// the axis, each with its sigma.
struct GeometryErrors {
  double position_sigma = 0.0;                 ///< m
  double direction_sigma = 0.0;                ///< rad
  double zero_sigma = 0.0;                     ///< rad
  std::optional<double> wrist_position_sigma;  ///< m; for axes 5 and 6: how far they miss the one before
  std::array<std::optional<AxisError>, 6> listed;
};

struct MachineSpec {
  std::array<JointStiffness, 6> joints;
  std::optional<Eigen::Vector3d> base_rotation;  ///< of pedestal and floor about base_link x, y, z; Nm/rad
  std::vector<LinkBeam> links;                   ///< in order of joint
  GeometryErrors geometry;
  double mass_relative_sigma = 0.0;  ///< true link mass / the URDF's - 1
  Tool tool;
  double base_tilt = 0.0;          ///< rad, of base_link against gravity
  double base_tilt_azimuth = 0.0;  ///< rad, of the horizontal axis it is tilted about, from base_link +x
  bool base_tilt_declared = false;
};

}  // namespace stiffscope::simulation
