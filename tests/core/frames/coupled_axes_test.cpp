#include "core/frames/coupled_axes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/robot/read_urdf.h"

// Axes of an arm whose rods hold the forearm, found from sweeps of a machine that is turned here by rotations of its
// own.

namespace stiffscope {
namespace coupled_axes_test {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Translation3d, Eigen::Vector3d;

const char* const kUrdf = R"(<robot name="rods"><link name="base"/><link name="l1"/><link name="l2"/><link name="rod"/>
<link name="l3"/><link name="l4"/><link name="tool"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.3 0 0.7"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3"/></joint>
<joint name="rods" type="revolute"><parent link="l2"/><child link="rod"/><origin xyz="0 0 1.1"/><axis xyz="0 1 0"/>
<mimic joint="j2" multiplier="-1"/><limit lower="-3" upper="3"/></joint>
<joint name="j3" type="revolute"><parent link="rod"/><child link="l3"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/></joint>
<joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="1.4 0 0.2"/><axis xyz="1 0 0"/>
<limit lower="-3" upper="3"/></joint>
<joint name="face" type="fixed"><parent link="l4"/><child link="tool"/><origin xyz="0.2 0 0"/></joint></robot>)";

struct Axis {
  Vector3d point, direction;
};

/// As the machine was built, all joints at zero: axes 1, 2, the elbow (rods and joint 3) and 4.
struct Machine {
  Axis first{{0.0, 0.0, 0.0}, Vector3d(2e-4, -3e-4, 1.0).normalized()};
  Axis second{{0.3006, 0.0, 0.6996}, Vector3d(4e-4, 1.0, -2e-4).normalized()};
  Axis elbow{{0.3002, 0.0, 1.8007}, Vector3d(-3e-4, 1.0, 5e-4).normalized()};
  Axis fourth{{1.7, 0.0004, 2.0009}, Vector3d(1.0, 3e-4, -4e-4).normalized()};
};

Isometry3d turn(const Axis& about, double angle) {
  return Translation3d(about.point) * AngleAxisd(angle, about.direction) * Translation3d(-about.point);
}

const std::vector<Vector3d> kTargets{{2.0, 0.2, 2.0}, {1.95, -0.15, 2.15}, {1.9, -0.1, 1.8}};  // joints at zero
const Isometry3d kStationFromBase =
    Translation3d(-3.2, 1.1, 0.4) * AngleAxisd(0.7, Vector3d(0.1, 0.2, 1.0).normalized());

Vector3d read(const Machine& machine, const JointVector& q, const Vector3d& target) {
  // The rods hold the forearm: joint 2 alone moves the elbow and turns nothing beyond it.
  const Isometry3d elbow = turn(machine.first, q[0]) * turn(machine.second, q[1]) * turn(machine.elbow, -q[1]);
  return kStationFromBase * (elbow * turn(machine.elbow, q[2]) * turn(machine.fourth, q[3]) * target);
}

/// Each joint swept from a bent posture, in 24 stops of 5 degrees.
campaign::Campaign swept(const Machine& machine, double noise, unsigned seed) {
  campaign::Campaign day;
  day.robot = robot::parseUrdf(kUrdf, "rods.urdf", "base", "tool");
  day.targets.resize(kTargets.size());
  day.circle_sweeps.emplace();
  std::mt19937 random(seed);
  std::normal_distribution<double> reading(0.0, noise > 0.0 ? noise : 1.0);
  for (int joint = 0; joint < 4; ++joint) {
    for (int stop = 0; stop < 24; ++stop) {
      JointVector q(4);
      q << 0.2, -0.3, 0.4, 0.1;
      q[joint] += (stop - 12) * 5.0 * M_PI / 180.0;
      for (std::size_t t = 0; t < kTargets.size(); ++t) {
        campaign::CircleReading row;
        row.axis = joint;
        row.target = static_cast<int>(t);
        row.q = q;
        row.point = read(machine, q, kTargets[t]);
        if (noise > 0.0) row.point += Vector3d(reading(random), reading(random), reading(random));
        day.circle_sweeps->rows.push_back(row);
      }
    }
  }
  return day;
}

frames::CoupledAxes found(const campaign::Campaign& day) {
  frames::RigidPoints points;
  for (const campaign::CircleReading& row : day.circle_sweeps->rows) points.circle_sweeps.push_back(row.point);
  return frames::fitCoupledAxes(day, points);
}

/// How far a found axis is from where it is: two shifts (m) and two tilts (rad) across it.
Eigen::Vector4d missed(const metrology::MeasuredLine& line, const Axis& truth) {
  const Vector3d direction = kStationFromBase.linear() * truth.direction;
  // Where the true axis comes nearest to the point at which the found one is stated.
  Vector3d between = kStationFromBase * truth.point - line.line.point;
  between -= direction * (between.dot(line.line.direction) / direction.dot(line.line.direction));
  const Vector3d tilt = direction - line.line.direction;
  return {between.dot(line.across_u), between.dot(line.across_v), tilt.dot(line.across_u), tilt.dot(line.across_v)};
}

std::vector<Axis> axesOf(const Machine& machine) {
  return {machine.first, machine.second, machine.elbow, machine.elbow, machine.fourth};
}

campaign::Tracker trackerOf(double noise) {
  campaign::Tracker tracker;
  tracker.range_fixed = tracker.angle_fixed = noise;  // the same in all directions
  return tracker;
}

TEST(CoupledAxes, OfExactReadingsAreTheMachines) {
  const Machine machine;
  for (const bool declared : {true, false}) {
    campaign::Campaign day = swept(machine, 0.0, 0);
    if (declared) day.tracker = trackerOf(1e-5);
    const frames::CoupledAxes axes = found(day);
    ASSERT_TRUE(axes.reason.empty());
    ASSERT_EQ(axes.at_zero.size(), 5u);
    for (std::size_t i = 0; i < axes.at_zero.size(); ++i)
      EXPECT_LT(missed(axes.at_zero[i], axesOf(machine)[i]).cwiseAbs().maxCoeff(), 2e-6) << "axis " << i << declared;
    EXPECT_LT(axes.rms, 1e-6);
  }
}

TEST(CoupledAxes, MissTheMachineAsMuchAsTheySay) {
  const Machine machine;
  constexpr double kNoise = 2e-5;
  constexpr int kDays = 60;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(5);
  double per_dof = 0.0;
  for (unsigned seed = 1; seed <= kDays; ++seed) {
    campaign::Campaign day = swept(machine, kNoise, seed);
    // Every other day leaves the noise to be seen in the residuals.
    const bool declared = seed % 2 == 0;
    if (declared) day.tracker = trackerOf(kNoise);
    const frames::CoupledAxes axes = found(day);
    ASSERT_TRUE(axes.reason.empty());
    if (declared) per_dof += axes.chi2_per_dof / (kDays / 2);
    for (std::size_t i = 0; i < 5; ++i) {
      const Eigen::Vector4d off = missed(axes.at_zero[i], axesOf(machine)[i]);
      squares[static_cast<Eigen::Index>(i)] += off.dot(axes.at_zero[i].covariance.ldlt().solve(off)) / kDays;
    }
  }
  EXPECT_NEAR(per_dof, 1.0, 0.02);
  // Mean of sixty chi squares of four degrees of freedom: 4 +- 0.37.
  for (Eigen::Index i = 0; i < 5; ++i) EXPECT_NEAR(squares[i], 4.0, 1.2) << "axis " << i;
}

}  // namespace coupled_axes_test
}  // namespace stiffscope
