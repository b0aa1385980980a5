#pragma once

#include <optional>
#include <vector>

#include "core/robot/kinematics.h"

namespace stiffscope::robot {

/// Rotation vector (rad) of a rotation: its axis times its angle, 0 to pi.
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation);

struct InverseKinematicsOptions {
  double close = 1e-10;       ///< m and rad: a pose that is missed by less is reached
  int most_steps = 100;       ///< tried; each is a system of as many unknowns as joints
  double longest_step = 0.3;  ///< of any joint, rad: a longer Newton step is shortened, so that it stays on its branch
};

struct InverseKinematics {
  JointVector q;  ///< rad; not within the limits by itself, nor within one turn
  bool reached = false;
  double missed = 0.0;  ///< distance that is left, m
  double turned = 0.0;  ///< and angle, rad
};

/// Joint angles at which the rigid arm holds a tool at `base_from_tool`; any arm, no closed form. Damped
/// Newton steps from `start`,
///   (J^T J + m I) dq = J^T e,    e = (position left, rotation vector left), J at the tool's origin,
/// m falling while steps help and rising while they do not (K. Levenberg 1944, D. Marquardt 1963; in robotics C. W.
/// Wampler 1986), one metre weighing as one radian. Of the up to sixteen solutions it is the one that steps from
/// `start` lead to: from a solution of a pose nearby, the same branch. Not reached: out of reach, or `start` too far.
InverseKinematics inverseKinematics(const Robot& robot, const Eigen::Isometry3d& base_from_tool,
                                    const Eigen::Isometry3d& flange_from_tool, const JointVector& start,
                                    const InverseKinematicsOptions& options = {});

/// Solutions of one pose that differ by more than whole turns, each as near to the middle of the joints' limits as
/// whole turns bring it: those that some of `starts` lead to, in their order. Solutions that hang together (a singular
/// posture) count as one where they are nearer than 1e-3 rad.
std::vector<JointVector> inverseKinematicsBranches(const Robot& robot, const Eigen::Isometry3d& base_from_tool,
                                                   const Eigen::Isometry3d& flange_from_tool,
                                                   const std::vector<JointVector>& starts,
                                                   const InverseKinematicsOptions& options = {});

/// Joint angles moved by whole turns to where they are nearest to the middle of their limits.
JointVector withinTurns(const Robot& robot, const JointVector& q);

/// How near a posture is to a singularity: the least over the largest singular value of J at that point (base frame),
/// lengths over 1 m, of as many as there are joints, six at the most. 0 in a singularity.
double conditioningAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base);

}  // namespace stiffscope::robot
