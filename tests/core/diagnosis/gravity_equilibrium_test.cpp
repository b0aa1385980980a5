#include <gtest/gtest.h>

#include <cmath>
#include "core/diagnosis/diagnosis_input.h"
#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/robot/gravity_load.h"
#include "tests/fixtures/simulated_lab.h"

// Where the unloaded arm stands with effects in the model, and what the readings say of where the load pulls.

namespace stiffscope {
namespace gravity_equilibrium_test {

frames::LoadingGeometry heavyArm(const ChainArm& chain) {
  frames::LoadingGeometry geometry;
  geometry.arm = chain.robot();
  geometry.compliance = chain.noAngles();
  geometry.weight.links_known = true;
  geometry.weight.gravity_in_base = {0.0, 0.0, -9.8};
  geometry.weight.bodies.resize(7);
  geometry.weight.bodies[6] = {100.0, geometry.arm.base_from_flange_at_zero.translation()};
  return geometry;
}

// A rigid arm on a foot that rocks about y by 1e-5 rad/Nm under 980 N at the flange: phi = 1e-5 * 980 * x(phi),
// x(phi) = x cos(phi) + z sin(phi), solved here to the end; the first-order offset misses it by phi^2.
TEST(GravityEquilibrium, AFootThatRocksTurnsTheWholeArmByAFiniteAngle) {
  const ChainArm chain = exampleChain();
  const frames::LoadingGeometry geometry = heavyArm(chain);
  const JointVector q = JointVector::Zero(6);
  effects::LinearizationPoint at(6);
  const effects::EffectModel model = effects::modelsOf(effects::baseCompliance()).front();
  constexpr double kRock = 1e-5;
  at.present.push_back({&model, kRock * Eigen::VectorXd::Unit(5, 1)});
  const Eigen::Vector3d flange = geometry.arm.base_from_flange_at_zero.translation();
  double phi = 0.0;
  for (int round = 0; round < 50; ++round)
    phi = kRock * 980.0 * (flange.x() * std::cos(phi) + flange.z() * std::sin(phi));
  ASSERT_GT(phi, 5e-3);
  const Eigen::Vector3d expected = Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitY()) * flange;
  const effects::ArmState rest = effects::gravityEquilibrium(geometry, at, q);
  // Five rounds, each a hundredth of the last; the foot's moment about x is nothing here.
  EXPECT_LT((rest.flange.translation() - expected).norm(), 1e-9);
  EXPECT_LT((rest.posture.motion[1].translation() - rest.moved[1].translation()).norm(), 1e-12);
}

TEST(GravityEquilibrium, IsTheSaggedArmWithoutEffects) {
  const ChainArm chain = exampleChain();
  frames::LoadingGeometry geometry = heavyArm(chain);
  geometry.compliance = exampleCompliance();
  const JointVector q = degrees(10, 20, -15, 40, 50, -30);
  const effects::ArmState rest = effects::gravityEquilibrium(geometry, effects::LinearizationPoint(6), q),
                          plain = effects::stateAt(geometry, q, JointVector::Zero(6));
  EXPECT_EQ((rest.flange.matrix() - plain.flange.matrix()).norm(), 0.0);
}

// The tilt of joint 4's bearing moves bodies 4 and beyond, not those before.
TEST(GravityEquilibrium, ATiltMovesWhatItsBearingCarries) {
  const ChainArm chain = exampleChain();
  const frames::LoadingGeometry geometry = heavyArm(chain);
  const JointVector q = degrees(10, 20, -15, 40, 50, -30);
  effects::LinearizationPoint at(6);
  const effects::EffectModel model = effects::modelsOf(effects::bearingTilt()).front();
  at.present.push_back({&model, 1e-5 * Eigen::VectorXd::Unit(6, 3)});
  const effects::ArmState rest = effects::gravityEquilibrium(geometry, at, q),
                          plain = effects::stateAt(geometry, q, JointVector::Zero(6));
  for (std::size_t b = 0; b < 4; ++b)
    EXPECT_EQ((rest.posture.motion[b].matrix() - plain.posture.motion[b].matrix()).norm(), 0.0) << b;
  EXPECT_GT((rest.flange.translation() - plain.flange.translation()).norm(), 1e-4);
}

identification::LoadCase pulledAt(const Eigen::Vector3d& offset, const Eigen::Vector3d& force) {
  identification::LoadCase one;
  one.q = one.q_sagged = JointVector::Zero(6);
  one.flange_unloaded = Eigen::Isometry3d::Identity();
  one.wrench = {Eigen::Vector3d::Zero(), force, offset.cross(force)};
  return one;
}

TEST(LoadOffset, IsThePointAllPullsGoThrough) {
  const Eigen::Vector3d hook(0.05, -0.02, 0.11);
  const std::vector<identification::LoadCase> cases{pulledAt(hook, {0, 0, -900}), pulledAt(hook, {500, 0, -300}),
                                                    pulledAt(hook, {0, 700, 100})};
  const robot::Robot arm = exampleChain().robot();
  EXPECT_LT((diagnosis::loadOffset(arm, cases, 0.0) - hook).norm(), 1e-9);  // the ridge of 1e-12
  // One direction alone: what lies along the pull stays at the declared point.
  const Eigen::Vector3d found = diagnosis::loadOffset(arm, {cases.front()}, 0.5);
  EXPECT_LT((found - Eigen::Vector3d(hook.x(), hook.y(), 0.0)).norm(), 1e-5);
}

// An arm on a wall, its base turned about an axis of its own against R0.
TEST(StartState, DownIsTheCampaignsGravityInR0) {
  SimulatedLab lab;
  campaign::Campaign campaign = fullDay(lab, hangingForce);
  campaign.gravity_in_base = {8.0, -3.0, 5.0};
  frames::LoadingGeometry geometry;
  geometry.arm = lab.nominal.robot();
  geometry.r0_from_base_link = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  geometry.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, geometry.arm,
                                       geometry.r0_from_base_link);
  const effects::LinearizationPoint at = diagnosis::startState(campaign, geometry, {}).at;
  const Eigen::Vector3d expected = geometry.r0_from_base_link.linear() * campaign.gravity_in_base.normalized();
  EXPECT_LT((at.down - expected).norm(), 1e-12);
}

}  // namespace gravity_equilibrium_test
}  // namespace stiffscope
