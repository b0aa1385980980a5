#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>

#include "core/campaign/campaign.h"
#include "core/robot/robot.h"
#include "core/simulation/spec.h"

// What sizes of effects are measured by: noise-free campaigns, the rigid arm, the declared noise.

namespace stiffscope::validation {

/// A campaign without noise: everything that is wrong with it but scatter, the load cell's errors included.
campaign::Campaign withoutScatter(const simulation::SimulationSpec& spec);

/// The rigid arm at joint angles: its axes and its flange in base_link.
struct ArmNow {
  PerJoint<metrology::Line> axes;
  Eigen::Isometry3d flange;
};
ArmNow armAt(const robot::Robot& robot, const JointVector& q);

/// Declared sigma of one reading (m), in the axes of sightAxes: across the line of sight, across, along it.
Eigen::Vector3d sigmaAt(const campaign::Tracker& tracker, const Eigen::Vector3d& point);
Eigen::Matrix3d sightAxes(const campaign::Tracker& tracker, const Eigen::Vector3d& point);

/// Mean of some readings of one point.
struct MeanPoint {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  Eigen::Vector3d value() const { return sum / count; }
};

/// Means of the repeats, by (pose, step, target).
std::map<std::array<int, 3>, MeanPoint> stateMeans(const campaign::Campaign& campaign);

double rms(const Eigen::VectorXd& values);  ///< 0 of none

}  // namespace stiffscope::validation
