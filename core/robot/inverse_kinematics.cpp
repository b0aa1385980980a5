#include "core/robot/inverse_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrology/linear_algebra.h"

namespace stiffscope::robot {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// Where the tool stands at some joint angles, and what is left to the pose that is asked for.
struct ToolAt {
  ArmAxes axes;
  Eigen::Vector3d origin;
  Vector6d left;  ///< m, rad
};

ToolAt toolAt(const Robot& robot, const Eigen::Isometry3d& wanted, const Eigen::Isometry3d& flange_from_tool,
              const JointVector& q) {
  const ArmPosture posture = postureAt(robot, q);
  const Eigen::Isometry3d tool = flangeAt(robot, posture) * flange_from_tool;
  ToolAt at{axesAt(robot, posture), tool.translation(), Vector6d::Zero()};
  at.left << wanted.translation() - tool.translation(), rotationVector(wanted.linear() * tool.linear().transpose());
  return at;
}

}  // namespace

InverseKinematics inverseKinematics(const Robot& robot, const Eigen::Isometry3d& base_from_tool,
                                    const Eigen::Isometry3d& flange_from_tool, const JointVector& start,
                                    const InverseKinematicsOptions& options) {
  constexpr double kLeastDamping = 1e-12, kMostDamping = 1e6;
  InverseKinematics found{start};
  ToolAt at = toolAt(robot, base_from_tool, flange_from_tool, found.q);
  double damping = 1e-6;
  for (int step = 0; step < options.most_steps && at.left.cwiseAbs().maxCoeff() >= options.close; ++step) {
    const Jacobian jacobian = jacobianAt(at.axes, at.origin);
    JointMatrix normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += damping;
    JointVector change = solvePositive(normal, jacobian.transpose() * at.left);
    const double longest = change.cwiseAbs().maxCoeff();
    if (longest > options.longest_step) change *= options.longest_step / longest;
    const JointVector next = found.q + change;
    const ToolAt there = toolAt(robot, base_from_tool, flange_from_tool, next);
    if (there.left.squaredNorm() < at.left.squaredNorm()) {
      found.q = next;
      at = there;
      damping = std::max(kLeastDamping, 0.1 * damping);
    } else if (damping >= kMostDamping) {
      break;
    } else {
      damping *= 10.0;
    }
  }
  found.missed = at.left.head<3>().norm();
  found.turned = at.left.tail<3>().norm();
  found.reached = at.left.cwiseAbs().maxCoeff() < options.close;
  return found;
}

JointVector withinTurns(const Robot& robot, const JointVector& q) {
  JointVector moved = q;
  for (int j = 0; j < robot.joints(); ++j) {
    // A whole turn of a joint that drives others by a part of its angle leaves these elsewhere.
    if (!robot.axes_in_base_at_zero.turnsAlone(j)) continue;
    const JointLimits& limits = robot.limits[static_cast<std::size_t>(j)];
    const double middle =
        std::isfinite(limits.lower) && std::isfinite(limits.upper) ? 0.5 * (limits.lower + limits.upper) : 0.0;
    moved[j] = middle + std::remainder(q[j] - middle, kWholeTurn);
  }
  return moved;
}

std::vector<JointVector> inverseKinematicsBranches(const Robot& robot, const Eigen::Isometry3d& base_from_tool,
                                                   const Eigen::Isometry3d& flange_from_tool,
                                                   const std::vector<JointVector>& starts,
                                                   const InverseKinematicsOptions& options) {
  constexpr double kSame = 1e-3;
  std::vector<JointVector> branches;
  for (const JointVector& start : starts) {
    const InverseKinematics found = inverseKinematics(robot, base_from_tool, flange_from_tool, start, options);
    if (!found.reached) continue;
    const JointVector q = withinTurns(robot, found.q);
    const bool known = std::any_of(branches.begin(), branches.end(), [&](const JointVector& other) {
      const JointVector apart = (q - other).unaryExpr([](double a) { return std::remainder(a, kWholeTurn); });
      return apart.cwiseAbs().maxCoeff() < kSame;
    });
    if (!known) branches.push_back(q);
  }
  return branches;
}

double conditioningAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  const Eigen::VectorXd singular = singularValues(jacobianAt(axes, point_in_base));
  return singular[singular.size() - 1] / singular[0];
}

}  // namespace stiffscope::robot
