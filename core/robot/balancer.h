#pragma once

#include <optional>
#include <variant>

#include "core/robot/kinematics.h"

namespace stiffscope::robot {

/// A coil spring by its maker's data: `tension_n` at `length_m`, and `rate_n_per_m` more by length. Pulls its ends
/// together where the tension is positive.
struct SpringLaw {
  double rate_n_per_m = 0.0, tension_n = 0.0, length_m = 0.0;
};

/// A gas cylinder: gauge pressure and gas volume at `length_m`, p V^exponent constant with p absolute (1: the gas keeps
/// its temperature, as it does at rest). `pushes`: its volume grows with its length, else it shrinks and it pulls.
struct GasLaw {
  double pressure_pa = 0.0, area_m2 = 0.0, volume_m3 = 0.0, length_m = 0.0, exponent = 1.0;
  bool pushes = false;
};

/// A point of a body, where it stands in the base frame with all joints at zero.
struct BalancerEnd {
  int body = 0;
  Eigen::Vector3d in_base_at_zero = Eigen::Vector3d::Zero();
};

/// A spring or a gas cylinder between two bodies of the arm, that carries some of its weight.
struct Balancer {
  std::variant<SpringLaw, GasLaw> law;
  BalancerEnd from, to;
  std::optional<double> shortest_m, longest_m;  ///< its stroke
};

/// What it pulls its ends together with at a length, N, and how that grows by length, N/m.
struct Tension {
  double force_n = 0.0, slope_n_per_m = 0.0;
};
Tension tensionAt(const Balancer& balancer, double length_m);

double lengthAt(const Balancer& balancer, const ArmPosture& posture);

/// Whether its stroke reaches this length, and its gas still has a volume there.
bool withinStroke(const Balancer& balancer, double length_m);

/// Its torques about the axes, Nm: the tension times how the length shrinks by angle. Couplings are the caller's.
JointVector balancerTorque(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer);

/// How these change by the axes' angles, Nm/rad: by the change of tension and by that of direction.
JointMatrix balancerStiffness(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer);

}  // namespace stiffscope::robot
