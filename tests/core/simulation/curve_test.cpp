#include <array>
#include <cmath>
#include "core/simulation/machine.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation;
using namespace simulation_test;
using Eigen::Vector3d;

namespace curve_test {

/// A massless arm on the spring of axis 2 alone, lying at zero: a force F downwards at the flange, 1.6 m
/// ahead of the axis, turns it by 1.6 F / k (to the twist itself, relatively; twists here are below 1e-3).
simulation::SimulationSpec axisTwo(double rate) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.joints[1].torsion = rate;
  return spec;
}

simulation::AppliedLoad down(double force) { return simulation::DeadForce{Vector3d::Zero(), Vector3d(0, 0, -force)}; }

double twist(const simulation::SimulationSpec& spec, double force) {
  const simulation::MachineState state =
      simulation::equilibrium(simulation::buildMachine(spec), JointVector::Zero(6), down(force));
  EXPECT_TRUE(state.converged);
  return state.deformation[0];
}

// 100 Nm at 1e5 Nm/rad, then 200 Nm more at 2e5: 1 mrad each, and 0.05 J, 0.1 J + 0.1 J.
TEST(SimulationCurve, stagesByHand) {
  simulation::TorqueCurve curve;
  curve.positive = curve.negative = simulation::stagesByTorque({100.0}, {1e5, 2e5});
  const simulation::CurvePoint point = simulation::evaluate(curve, 2e-3, nullptr);
  EXPECT_NEAR(point.torque, 300.0, 1e-10);
  EXPECT_NEAR(point.energy, 0.25, 1e-14);
  EXPECT_EQ(point.rate, 2e5);
  EXPECT_NEAR(simulation::evaluate(curve, -2e-3, nullptr).torque, -300.0, 1e-10);
}

// One slider of 1000 Nm/rad that holds 10 Nm: driven to 0.03 it is at its limit, anchored at 0.02, and back
// at 0.015 it pulls the other way with 5 Nm. A whole cycle of +-a loses 4 limit (a - limit / rate).
TEST(SimulationCurve, sliderByHand) {
  simulation::TorqueCurve curve;
  curve.sliders = {{1000.0, 10.0}};
  double anchor = 0.0;
  EXPECT_EQ(simulation::evaluate(curve, 0.03, &anchor).torque, 10.0);
  simulation::slip(curve, 0.03, &anchor);
  EXPECT_NEAR(anchor, 0.02, 1e-17);
  EXPECT_NEAR(simulation::evaluate(curve, 0.015, &anchor).torque, -5.0, 1e-13);
  double lost = 0.0;
  const int steps = 4000;
  for (int k = 0; k < steps; ++k) {  // from +0.03 once round, torque in the middle of each small step
    const double at = 0.03 * std::cos(2 * M_PI * (k + 0.5) / steps);
    const double by = -0.03 * std::sin(2 * M_PI * (k + 0.5) / steps) * 2 * M_PI / steps;
    lost += simulation::evaluate(curve, at, &anchor).torque * by;
    simulation::slip(curve, at, &anchor);
  }
  EXPECT_NEAR(lost, 4 * 10.0 * (0.03 - 0.01), 1e-5);  // midpoint rule over 4000 steps, corners included
}

TEST(SimulationCurve, torqueIsTheEnergysSlopeAndRateTheTorques) {
  simulation::TorqueCurve curve;
  curve.positive = {{0.0, 1e-3}, {5e4, 4e-3}, {2e5}};
  curve.negative = {{1e4}};
  curve.cubic = 1e9;
  curve.sliders = {{1e4, 15.0}, {3e4, 60.0}};
  const std::array<double, 2> anchors{1e-3, -5e-4};
  for (const double at : {-7e-3, -1.2e-3, 3e-4, 2.2e-3, 6e-3}) {  // no corner within 1e-6 of these
    const double h = 1e-6;
    const simulation::CurvePoint up = simulation::evaluate(curve, at + h, anchors.data()),
                                 below = simulation::evaluate(curve, at - h, anchors.data());
    const simulation::CurvePoint point = simulation::evaluate(curve, at, anchors.data());
    EXPECT_NEAR((up.energy - below.energy) / (2 * h), point.torque, 1e-5) << at;  // cubic t h^2
    EXPECT_NEAR((up.torque - below.torque) / (2 * h), point.rate, 1e-6 * point.rate + 1e-2) << at;
  }
}

// k3 t^3 + k t = T, solved by Cardano's formula for a = k / k3, b = T / k3.
TEST(SimulationCurve, cubicHardeningByHand) {
  simulation::SimulationSpec spec = axisTwo(1e6);
  spec.machine.joints[1].cubic = 5e11;
  const double torque = 1.6 * 1000.0, a = 1e6 / 5e11, b = torque / 5e11;
  const double root = std::sqrt(b * b / 4 + a * a * a / 27);
  const double t = std::cbrt(b / 2 + root) + std::cbrt(b / 2 - root);
  EXPECT_NEAR(twist(spec, 1000.0), t, 2e-3 * t);  // the lever arm changes by the twist, 1e-3
  EXPECT_LT(t, 0.9 * torque / 1e6);
}

// Lost motion of 1 mrad: a weight on the flange keeps the gap closed to one side, so that loads downward are
// carried as without it; a load up that more than takes the weight crosses it.
TEST(SimulationCurve, backlashIsCrossedByTheWholeTorque) {
  simulation::SimulationSpec with = axisTwo(1e6), without = axisTwo(1e6);
  with.machine.joints[1].backlash = simulation::JointBacklash{1e-3, 0.001};
  for (simulation::SimulationSpec* spec : {&with, &without}) spec->machine.tool = {50.0, Vector3d::Zero()};
  const double rest_with = twist(with, 0.0), rest_without = twist(without, 0.0);
  // In the gap 0.001 of the rate is felt: it takes 0.5 Nm of the 785 Nm, worth 5e-7 rad.
  EXPECT_NEAR(rest_with - rest_without, 0.5e-3, 1.1e-6);
  EXPECT_NEAR(twist(with, 400.0) - rest_with, twist(without, 400.0) - rest_without, 1e-6);
  EXPECT_NEAR(twist(with, -1000.0) - rest_with, twist(without, -1000.0) - rest_without - 1e-3, 3e-6);
}

// One slider, out and back: k t1 + f = T on the way out, k t + kf (t - (t1 - f/kf)) = 0 on the way back.
TEST(SimulationCurve, frictionKeepsTheWayBackFromTheWayOut) {
  simulation::SimulationSpec spec = axisTwo(1e6);
  const double f = 100.0, kf = 2e5, torque = 1.6 * 500.0;
  spec.machine.joints[1].friction = simulation::JointFriction{f, kf, 1};
  spec.loading.emplace();
  spec.loading->load = simulation::CablePull{{500.0}, std::nullopt, Vector3d(0, 0, -1)};
  spec.loading->repeats = 1;
  spec.postures.push_back({JointVector::Zero(6), {}});
  const campaign::Campaign campaign = simulation::measureWithoutNoise(simulation::buildMachine(spec), spec);
  const double out = (torque - f) / 1e6, back = kf * (out - f / kf) / (1e6 + kf);
  const auto height = [&](std::size_t step) { return campaign.loading->rows[3 * step].point.z(); };
  const double lever = 1.6 + 0.06;                                      // the target stands 0.06 m ahead of the flange
  EXPECT_NEAR(height(0) - height(1), lever * out, 2e-3 * lever * out);  // relative to the twist, 1e-3
  EXPECT_NEAR(height(0) - height(2), lever * back, 3e-3 * lever * out);
  EXPECT_LT(kf * (out - f / kf - back), f);  // or it would slip again
  EXPECT_GT(back, 0.04 * out);
}

// The same day again from the unloaded state: what friction holds is worked off by the motion between.
TEST(SimulationCurve, frictionStartsAnewAtEveryPosture) {
  simulation::SimulationSpec spec = axisTwo(1e6);
  spec.machine.joints[1].friction = simulation::JointFriction{100.0, 4e5, 4};
  spec.loading.emplace();
  spec.loading->load = simulation::HangingWeights{{20.0, 60.0}};
  spec.postures = {{JointVector::Zero(6), {}}, {JointVector::Zero(6), {}}};
  const campaign::Campaign campaign = simulation::measureWithoutNoise(simulation::buildMachine(spec), spec);
  const std::size_t half = campaign.loading->rows.size() / 2;
  for (std::size_t r = 0; r < half; ++r) {
    EXPECT_EQ(campaign.loading->rows[r].point, campaign.loading->rows[half + r].point);
  }
}

}  // namespace curve_test

}  // namespace stiffscope
