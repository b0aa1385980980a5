#pragma once

#include <optional>
#include <vector>

// How one joint gives and turns. SI and radians.

namespace stiffscope::simulation {

/// Friction inside a joint: `sliders` Jenkins elements in parallel, of equal rate, whose limits rise evenly
/// (1 : 2 : ... : n); `torque` is what all of them hold, `rate` what they add while all stick. The motor's
/// motion on the way to a posture works it off: at arrival they carry nothing.
struct JointFriction {
  double torque = 0.0;  ///< Nm
  double rate = 0.0;    ///< Nm/rad
  int sliders = 4;
};

/// Lost motion of the drive: `width` (rad) in all through which only `rest` of the rate is felt. The joint's
/// whole torque crosses it, weight included.
struct JointBacklash {
  double width = 0.0;
  double rest = 0.001;  ///< grease and seals; above 0
};

/// A drive whose rate changes at these torques (a catalogue's T1, T2 and K1, K2, K3).
struct JointStages {
  std::vector<double> torques;  ///< Nm, rising, above 0
  std::vector<double> rates;    ///< Nm/rad, one more; the joint's `torsion` is left aside
};

/// A sum that follows the joint's angle: amplitude sin(cycles q + phase).
struct JointWave {
  double amplitude = 0.0, cycles = 1.0, phase = 0.0;
};

/// A stiffness that falls as the drive gets warm: by `share` of itself, approached as 1 - exp(-t /
/// time_constant) from the first reading of the day.
struct JointSoftening {
  double share = 0.0, time_constant = 0.0;
};

/// How one joint gives. Absent: it does not. What follows `bearing` needs `torsion`.
struct JointStiffness {
  std::optional<double> torsion;  ///< about its axis, Nm/rad
  std::optional<double> bearing;  ///< about each direction across its axis, at the axis's point, Nm/rad
  double cubic = 0.0;             ///< Nm/rad^3, times twist cubed, besides the rest; >= 0
  std::optional<JointStages> stages = std::nullopt;
  std::optional<JointBacklash> backlash = std::nullopt;
  std::optional<JointFriction> friction = std::nullopt;
  std::optional<JointWave> rate_wave = std::nullopt;   ///< of the rate, as a share of it; |amplitude| < 1
  std::optional<JointWave> angle_wave = std::nullopt;  ///< true motor angle less reported, rad
  std::optional<JointSoftening> softening = std::nullopt;
};

}  // namespace stiffscope::simulation
