#pragma once

#include "core/robot/kinematics.h"
#include "core/robot/wrench.h"

namespace stiffscope::robot {

/// What it pulls its ends together with at a length, N, and how that grows by length, N/m.
struct Tension {
  double force_n = 0.0, slope_n_per_m = 0.0;
};
Tension tensionAt(const Balancer& balancer, double length_m);

/// The length that its data are stated for, m.
double statedLength(const Balancer& balancer);

/// A balancer at a posture. Axes from `inner` to before `outer`, which are also its bodies' numbers, turn one end
/// against the other.
struct PlacedBalancer {
  int inner = 0, outer = 0;
  Eigen::Vector3d inner_end, outer_end;  ///< base frame
  Eigen::Vector3d direction;             ///< from the inner end to the outer, unit
  double length = 0.0;
  Tension tension;

  Eigen::Vector3d onOuter() const { return -tension.force_n * direction; }  ///< N; the inner body gets the opposite
};
PlacedBalancer placedAt(const Balancer& balancer, const ArmPosture& posture);

/// Brings both ends into another frame, of which `motion` gives the place of the one they are in.
void moveEnds(const Eigen::Isometry3d& motion, Balancer& balancer);

double lengthAt(const Balancer& balancer, const ArmPosture& posture);

/// Whether its stroke reaches this length, its gas still has a volume there, and its ends are apart.
bool withinStroke(const Balancer& balancer, double length_m);

/// Its torques about the axes, Nm: the tension times how the length shrinks by angle. Couplings are the caller's.
JointVector balancerTorque(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer);

/// Adds what it pulls with to the wrench, about the base's origin, on all bodies from each one outwards: the bodies
/// beyond both of its ends or inside both carry nothing.
void addBalancerForces(const Balancer& balancer, const ArmPosture& posture, PerBody<Wrench>& from_body);

/// How its torques change by the axes' angles, Nm/rad: by the change of tension and by that of direction.
JointMatrix balancerStiffness(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer);

}  // namespace stiffscope::robot
