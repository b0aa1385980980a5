#pragma once

#include <Eigen/Dense>
#include <array>
#include <numbers>
#include "core/robot/robot.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {

/// The tests' own arm: joint frames one in the other, multiplied out joint by joint as a URDF has them.
/// Nothing of it is the product-of-exponentials form that it is to check.
struct ChainArm {
  std::array<Eigen::Isometry3d, 6>
      to_joint;  ///< from the frame of the body before to the joint's frame, joint at zero
  std::array<Eigen::Vector3d, 6> axis;  ///< in the joint's frame
  Eigen::Isometry3d to_flange = Eigen::Isometry3d::Identity();
  std::array<double, 6> mass{};             ///< of the body beyond each joint, kg
  std::array<Eigen::Vector3d, 6> centre{};  ///< of mass, in the joint's frame

  /// base_from_joint of every joint, turned; [6] is base_from_flange.
  std::array<Eigen::Isometry3d, 7> framesAt(const Vector6d& q) const {
    std::array<Eigen::Isometry3d, 7> frames;
    Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
    for (std::size_t j = 0; j < 6; ++j) {
      at = at * to_joint[j];
      at.rotate(Eigen::AngleAxisd(q[static_cast<Eigen::Index>(j)], axis[j]));
      frames[j] = at;
    }
    frames[6] = at * to_flange;
    return frames;
  }
  Eigen::Isometry3d flangeAt(const Vector6d& q) const { return framesAt(q)[6]; }

  /// Torque on each joint of a force that acts at a point of body `body` (1..6) and a moment, statics by
  /// hand: axis . (M + (point - joint) x F).
  Vector6d torqueOf(const Vector6d& q, int body, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                    const Eigen::Vector3d& moment) const {
    const auto frames = framesAt(q);
    Vector6d torque = Vector6d::Zero();
    for (int j = 0; j < body; ++j) {
      const Eigen::Isometry3d& joint = frames[static_cast<std::size_t>(j)];
      const Eigen::Vector3d direction = joint.linear() * axis[static_cast<std::size_t>(j)];
      torque[j] = direction.dot(moment + (point - joint.translation()).cross(force));
    }
    return torque;
  }

  Vector6d weightTorque(const Vector6d& q) const {
    const auto frames = framesAt(q);
    Vector6d torque = Vector6d::Zero();
    for (std::size_t b = 0; b < 6; ++b) {
      torque += torqueOf(q, static_cast<int>(b) + 1, frames[b] * centre[b], {0, 0, -9.80665 * mass[b]},
                         Eigen::Vector3d::Zero());
    }
    return torque;
  }

  /// The same arm as the code under test takes it.
  robot::Robot robot() const {
    const auto frames = framesAt(Vector6d::Zero());
    robot::Robot robot;
    robot.name = "chain";
    for (std::size_t j = 0; j < 6; ++j) {
      robot.axes_in_base_at_zero[j] = {frames[j].translation(), frames[j].linear() * axis[j]};
      robot.limits[j] = {-6.2, 6.2};
      robot.joint_names[j] = "joint_" + std::to_string(j + 1);
      robot.bodies[j + 1] = {mass[j], frames[j] * centre[j]};
    }
    robot.base_from_flange_at_zero = frames[6];
    robot.links = {{"base_link", 0, Eigen::Isometry3d::Identity()}, {"tool0", 6, frames[6]}};
    return robot;
  }

  /// Every joint frame put a little elsewhere, as a real arm has it.
  ChainArm disturbed(Noise& noise, double shift, double turn) const {
    ChainArm other = *this;
    for (Eigen::Isometry3d& one : other.to_joint) {
      one.translate(shift * noise.normal3());
      one.rotate(Eigen::AngleAxisd(turn * noise.normal(), noise.direction()));
    }
    return other;
  }
};

/// An arm of the size of a FANUC M-900iB/700, masses round numbers; wrist axes that meet.
inline ChainArm exampleChain() {
  ChainArm arm;
  const Eigen::Vector3d steps[6] = {{0, 0, 0.94}, {0.41, 0, 0},  {0, 0, 1.12},
                                    {0, 0, 0.25}, {1.285, 0, 0}, {0.3, 0, 0}};
  const Eigen::Vector3d axes[6] = {{0, 0, 1}, {0, 1, 0}, {0, -1, 0}, {-1, 0, 0}, {0, -1, 0}, {-1, 0, 0}};
  const Eigen::Vector3d centres[6] = {{0.15, 0, -0.2}, {0, 0, 0.5},  {-0.1, 0, 0.15},
                                      {0.7, 0, 0},     {0.05, 0, 0}, {0, 0, 0}};
  arm.mass = {1000, 550, 650, 160, 60, 15};
  for (std::size_t j = 0; j < 6; ++j) {
    arm.to_joint[j].setIdentity();
    arm.to_joint[j].translation() = steps[j];
    arm.axis[j] = axes[j];
    arm.centre[j] = centres[j];
  }
  arm.to_flange.linear() << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  return arm;
}

inline Vector6d degrees(double a, double b, double c, double d, double e, double f) {
  return (Vector6d() << a, b, c, d, e, f).finished() * (std::numbers::pi / 180.0);
}

/// Compliances of the size of the paper's Table II, rad/Nm.
inline Vector6d exampleCompliance() {
  return (Vector6d() << 1 / 4.0, 1 / 3.2, 1 / 2.6, 1 / 0.42, 1 / 0.23, 1 / 0.089).finished() * 1e-6;
}

/// A posture as identification uses them: the wrist well away from straight.
inline Vector6d somePosture(Noise& noise) {
  const auto between = [&](double low, double high) { return low + (high - low) * noise.uniform(); };
  const double q1 = between(-60, 60), q2 = between(-30, 40), q3 = between(-40, 30), q4 = between(-120, 120),
               q5 = between(30, 90), q6 = between(-120, 120);
  return degrees(q1, q2, q3, q4, q5, q6);
}

}  // namespace stiffscope
