#pragma once

#include <gtest/gtest.h>

#include <numbers>
#include "core/simulation/equilibrium.h"
#include "core/simulation/measure.h"

namespace stiffscope::simulation_test {

inline constexpr double kDeg = std::numbers::pi / 180.0;

/// A six-axis arm with a spherical wrist, made by hand: shoulder at 0.4/0.9 m, 1.1 m and 1.3 m links, no
/// masses.
inline robot::Robot arm() {
  robot::Robot robot;
  robot.name = "arm";
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  robot.axes_in_base_at_zero = {metrology::Line{{0, 0, 0.9}, z},    metrology::Line{{0.4, 0, 0.9}, y},  metrology::Line{{0.4, 0, 2.0}, -y},
                                metrology::Line{{0.4, 0, 2.2}, -x}, metrology::Line{{1.7, 0, 2.2}, -y}, metrology::Line{{2.0, 0, 2.2}, -x}};
  for (int i = 0; i < 6; ++i) {
    robot.joint_names[i] = "joint_" + std::to_string(i + 1);
    robot.limits[i] = {-3.2, 3.2};
  }
  robot.base_from_flange_at_zero.translation() = Eigen::Vector3d(2.0, 0, 2.2);
  robot.base_from_flange_at_zero.linear() =
      (Eigen::Matrix3d() << 0, 0, 1, 0, -1, 0, 1, 0, 0).finished();  // z forward, x up
  robot.links = {{"base_link", 0, Eigen::Isometry3d::Identity()},
                 {"tool0", 6, robot.base_from_flange_at_zero}};
  return robot;
}

/// The arm with a spring in every joint and every bearing, three targets, a tracker 4 m away; nothing
/// measured.
inline simulation::SimulationSpec armSpec() {
  simulation::SimulationSpec spec;
  spec.name = "test";
  spec.date = "2026-01-01";
  spec.seed = 7;
  spec.nominal = arm();
  spec.base_link = "base_link";
  spec.flange_link = "tool0";
  const double torsion[6] = {4e6, 3e6, 2.5e6, 4e5, 2e5, 9e4};
  const double bearing[6] = {5e7, 1.6e7, 1e7, 2e6, 6e5, 3e5};
  for (int i = 0; i < 6; ++i) spec.machine.joints[i] = {torsion[i], bearing[i]};
  spec.targets = {{"P10", {0.26, 0.03, 0.06}}, {"P11", {-0.16, 0.21, 0.04}}, {"P12", {-0.11, -0.24, 0.08}}};
  spec.tracker.base_from_tracker.translation() = Eigen::Vector3d(4.0, -1.0, 1.0);
  spec.tracker.declared = {"tracker", 4e-6, 0.6e-6, 6e-6, 2.4e-6, Eigen::Vector3d::Zero()};
  return spec;
}

/// The same with weight, tool, errors, a soft base and two link beams: everything that the simulator knows.
inline simulation::SimulationSpec fullSpec() {
  simulation::SimulationSpec spec = armSpec();
  const double mass[7] = {700, 750, 500, 550, 180, 90, 30};
  for (int b = 0; b < 7; ++b) {
    const Eigen::Vector3d place(0.3 * b, 0.02 * b, 1.0 + 0.15 * b);
    spec.nominal.bodies[b] = {mass[b], place};
  }
  spec.machine.tool = {60.0, {0.01, -0.02, 0.09}};
  spec.machine.base_rotation = Eigen::Vector3d(2e7, 3e7, 5e7);
  spec.machine.links = {{1, 2e7, 1e7, 4e8, 3e9}, {3, 6e6, 4e6, std::nullopt, std::nullopt}};
  spec.machine.geometry.position_sigma = 2e-4;
  spec.machine.geometry.direction_sigma = 0.02 * kDeg;
  spec.machine.geometry.zero_sigma = 0.02 * kDeg;
  spec.machine.geometry.wrist_position_sigma = 2e-5;
  spec.machine.mass_relative_sigma = 0.03;
  spec.machine.base_tilt = 0.5 * kDeg;
  return spec;
}

inline Vector6d posture() { return kDeg * (Vector6d() << 20, 15, -25, 40, 55, -70).finished(); }

}  // namespace stiffscope::simulation_test
