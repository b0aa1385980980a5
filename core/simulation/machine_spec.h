#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/simulation/joint_spec.h"
#include "core/simulation/link_spring.h"

// The described machine: how it gives, how its geometry and masses differ from nominal. SI and radians.

namespace stiffscope::simulation {

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

/// A crack or a shim under the pedestal: beyond `gap` (rad) of turn to one side about base_link x, y or z it
/// rests on something more.
struct OneSidedContact {
  int axis = 0;            ///< 0..2
  bool positive = true;    ///< the side of the turn where it touches
  double stiffness = 0.0;  ///< Nm/rad, besides base_rotation
  double gap = 0.0;        ///< rad
};

/// The plate between flange and everything on it (reflectors, hook, tool), about the flange's origin.
struct ToolPlate {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< along flange x, y, z; N/m
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< about them; Nm/rad
};

/// Two transmissions that share a spring: it stretches by arms[0] t_a + arms[1] t_b, t the elastic twists of
/// the joints (the motors set its zero), and pulls back with `rate`. A rod of a parallelogram: N/m and crank
/// radii in m. A shaft of a differential wrist: Nm/rad and ratios. Its energy is 1/2 rate stretch^2, so what
/// joint a does to b, b does to a.
struct SharedSpring {
  std::array<int, 2> joints{};  ///< 0..5
  std::array<double, 2> arms{};
  double rate = 0.0;
};

/// A link that grows as the day goes on: `growth` (m) along it, from the point of joint `joint` to that of
/// the next one, approached as growth (1 - exp(-t / time_constant)) from the first reading.
struct ThermalGrowth {
  int joint = 0;  ///< 0..4
  double growth = 0.0, time_constant = 0.0;
};

/// Material that gives at once only in part: of every change of the elastic coordinates the share `share`
/// comes late, as exp(-t / time_constant) from the change of load.
struct Creep {
  double share = 0.0, time_constant = 0.0;
};

struct MachineSpec {
  std::array<JointStiffness, 6> joints;
  std::optional<Eigen::Vector3d> base_rotation;     ///< of pedestal and floor about base_link x, y, z; Nm/rad
  std::optional<Eigen::Vector3d> base_translation;  ///< the same along x, y, z; N/m
  std::vector<OneSidedContact> base_contacts;       ///< about axes that base_rotation lets turn
  std::vector<LinkBeam> links;                      ///< in order of joint
  std::optional<ToolPlate> tool_plate;
  std::vector<SharedSpring> shared_springs;  ///< between joints whose torsion gives
  std::vector<LinkSpring> link_springs;
  std::vector<ThermalGrowth> growths;
  std::optional<Creep> creep;
  GeometryErrors geometry;
  double mass_relative_sigma = 0.0;  ///< true link mass / the URDF's - 1
  Tool tool;
  double base_tilt = 0.0;          ///< rad, of base_link against gravity
  double base_tilt_azimuth = 0.0;  ///< rad, of the horizontal axis it is tilted about, from base_link +x
  bool base_tilt_declared = false;
};

}  // namespace stiffscope::simulation
