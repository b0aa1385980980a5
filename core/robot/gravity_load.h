#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/robot/kinematics.h"

namespace stiffscope::robot {

/// What hangs on the flange all the time.
struct Tool {
  double mass_kg = 0.0;
  Eigen::Vector3d com_in_flange = Eigen::Vector3d::Zero();
};

/// The arm's own weight as dead loads: each body's mass at its centre, the tool with the last body; and the balancers
/// that carry some of it.
struct GravityLoad {
  PerBody<BodyMass> bodies;                                   ///< centres in the base frame of the arm, joints zero
  Eigen::Vector3d gravity_in_base = Eigen::Vector3d::Zero();  ///< m/s^2
  bool links_known = false;         ///< false: the URDF states no link masses. Balancers do not stand in for these
  std::vector<Balancer> balancers;  ///< ends in the base frame of the arm

  bool any() const;  ///< whether a body weighs or a balancer acts
};

/// Masses of `nominal`'s links (the URDF's, in base_link), its balancers, and the mass of the tool, which the flange of
/// `arm` carries, brought to `base_from_base_link` axes (R0 or base_link). Link masses are known when every body beyond
/// joint 2 states one (of coupled joints those that a joint of its own turns).
GravityLoad gravityLoad(const Robot& nominal, const std::optional<Tool>& tool,
                        const Eigen::Vector3d& gravity_in_base_link, const Robot& arm,
                        const Eigen::Isometry3d& base_from_base_link);

/// Masses of the URDF all off by one factor; the tool's is apart, and a balancer's force is none of them.
void scaleMasses(double factor, Robot& robot);

/// Joint torques of the own weight and of the balancers at a posture, Nm.
JointVector weightTorque(const Robot& robot, const ArmPosture& posture, const GravityLoad& weight);

/// Joint angles of the arm with its springs loaded by its own weight: q + c * weightTorque(q + ...), rad.
/// `compliance` c in rad/Nm. Fixed-point iteration: the sag is small against the posture, three steps reach 1e-9 rad.
JointVector saggedAngles(const Robot& robot, const JointVector& q, const GravityLoad& weight,
                         const JointVector& compliance);

}  // namespace stiffscope::robot
