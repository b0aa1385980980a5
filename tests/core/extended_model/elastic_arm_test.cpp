#include "core/effects/elastic_arm.h"

#include <gtest/gtest.h>

#include <array>
#include "core/effects/all.h"
#include "core/simulation/equilibrium.h"
#include "tests/fixtures/extended_day.h"

// The arm at rest with effects of known size against the simulator's equilibrium, which minimises an energy of its own
// mechanism: what the two share is the machine's description.

namespace stiffscope {
namespace elastic_arm_test {

struct Mechanism {
  const char* name;
  effects::Effect effect;
  void (*build)(simulation::SimulationSpec& spec, Eigen::VectorXd& parameters);
};

class AgainstTheSimulator : public testing::TestWithParam<Mechanism> {};

TEST_P(AgainstTheSimulator, DeflectsTheSameWithFiniteRotations) {
  simulation::SimulationSpec spec = springsAlone(1);
  const campaign::Campaign campaign = simulation::simulate(spec);
  const effects::EffectModel model = effects::modelsOf(effects::recordOf(GetParam().effect)).front();
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.parameters()));
  GetParam().build(spec, parameters);
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  frames::LoadingGeometry geometry;
  geometry.arm = simulation::rigidGeometry(machine);
  geometry.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, machine.nominal,
                                       Eigen::Isometry3d::Identity());
  JointVector compliance(6);
  for (std::size_t j = 0; j < 6; ++j) compliance[static_cast<Eigen::Index>(j)] = 1.0 / *spec.machine.joints[j].torsion;
  const effects::LinearizationPoint at{6};
  const effects::ElasticArm arm(geometry, compliance, at, {{&model, parameters}});
  const Eigen::Isometry3d& flange = geometry.arm.base_from_flange_at_zero;
  double most = 0.0;
  for (const std::size_t row : {0u, 25u, 50u}) {
    effects::PostureStates states(
        2, effects::stateAt(geometry, campaign.states->rows[row].q, JointVector::Zero(campaign.robot.joints())));
    states[1].loaded = true;
    const simulation::AppliedLoad load = simulation::loadAtStep(*spec.loading, 3, machine.gravity_in_base, {});
    const simulation::MachineState at_rest = simulation::equilibrium(machine, states[0].q),
                                   loaded = simulation::equilibrium(machine, states[0].q, load);
    const effects::ToolLoad own{flange * spec.loading->hook_in_flange, loaded.load_force_in_base,
                                Eigen::Vector3d::Zero()};
    const auto before = arm.toolMotion(states, 0, nullptr), after = arm.toolMotion(states, 1, &own);
    ASSERT_TRUE(before && after);
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      const Eigen::Vector3d place = flange * spec.targets[t].position_in_flange;
      const Eigen::Vector3d truth = loaded.targets_in_base[t] - at_rest.targets_in_base[t];
      most = std::max(most, truth.norm());
      // The simulator turns a joint's drive and bearing together, the arm one after the other: half the product of the
      // two angles (0.5 mrad each here) over a lever of 2 m, a quarter of a micrometre a joint.
      EXPECT_LT((*after * place - *before * place - truth).norm(), 1e-6);
    }
  }
  EXPECT_GT(most, 1.5e-3) << "deflections too small to show anything";
}

/// How far balancers alone move the reflectors of the unloaded arm: forces on the two bodies that each joins, through
/// joints, bearings, links and base.
TEST_P(AgainstTheSimulator, IsMovedByBalancersTheSame) {
  simulation::SimulationSpec spec = springsAlone(1);
  spec.machine.geometry = {};
  const effects::EffectModel model = effects::modelsOf(effects::recordOf(GetParam().effect)).front();
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.parameters()));
  GetParam().build(spec, parameters);
  simulation::SimulationSpec balanced = spec;
  // A cylinder behind the column, a spring from the foot, one along the forearm.
  balanced.machine.link_springs = {{1,
                                    2,
                                    {-0.5, 0, 0.94},
                                    {0.25, 0.1, 1.13},
                                    0.0,
                                    0.0,
                                    simulation::CylinderGas{150e5, 17e-4, 6e-3, 1.2, false},
                                    true},
                                   {0, 2, {-0.2, 0.3, 0.4}, {0.41, 0.2, 1.6}, 5e3, 4e3, std::nullopt, true},
                                   {3, 5, {0.3, 0.2, 2.3}, {1.8, 0.1, 2.4}, 2e3, 1e3, std::nullopt, true}};
  const simulation::ElasticMachine bare = simulation::buildMachine(spec), machine = simulation::buildMachine(balanced);
  const campaign::Campaign campaign = simulation::simulate(balanced);
  ASSERT_EQ(campaign.robot.balancers.size(), 3u);
  frames::LoadingGeometry geometry;
  geometry.arm = campaign.robot;
  geometry.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, campaign.robot,
                                       Eigen::Isometry3d::Identity());
  frames::LoadingGeometry without = geometry;
  without.weight.balancers.clear();
  JointVector compliance(6);
  for (std::size_t j = 0; j < 6; ++j) compliance[static_cast<Eigen::Index>(j)] = 1.0 / *spec.machine.joints[j].torsion;
  const effects::LinearizationPoint at{6};
  const effects::ElasticArm arm(geometry, compliance, at, {{&model, parameters}}),
      bare_arm(without, compliance, at, {{&model, parameters}});
  double most = 0.0;
  for (const std::size_t row : {0u, 25u, 50u}) {
    const effects::PostureStates states{
        effects::stateAt(geometry, campaign.states->rows[row].q, JointVector::Zero(campaign.robot.joints()))};
    const simulation::MachineState with = simulation::equilibrium(machine, states[0].q),
                                   before = simulation::equilibrium(bare, states[0].q);
    ASSERT_TRUE(with.converged && before.converged);
    const auto found = arm.toolMotion(states, 0, nullptr), found_before = bare_arm.toolMotion(states, 0, nullptr);
    ASSERT_TRUE(found && found_before);
    for (std::size_t t = 0; t < spec.targets.size(); ++t) {
      const Eigen::Vector3d place = geometry.arm.base_from_flange_at_zero * spec.targets[t].position_in_flange;
      const Eigen::Vector3d truth = with.targets_in_base[t] - before.targets_in_base[t];
      most = std::max(most, truth.norm());
      EXPECT_LT((*found * place - *found_before * place - truth).norm(), 2e-6);  // as above, of larger angles
    }
  }
  EXPECT_GT(most, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, AgainstTheSimulator,
                         testing::Values(Mechanism{"springs", effects::Effect::bearing_tilt,
                                                   [](simulation::SimulationSpec&, Eigen::VectorXd&) {}},
                                         Mechanism{"bearings", effects::Effect::bearing_tilt,
                                                   [](simulation::SimulationSpec& spec, Eigen::VectorXd& parameters) {
                                                     const std::array<double, 6> rates{5e7, 1.6e7, 1e7, 2e6, 6e5, 3e5};
                                                     for (std::size_t j = 0; j < 6; ++j) {
                                                       spec.machine.joints[j].bearing = rates[j];
                                                       parameters[static_cast<Eigen::Index>(j)] =
                                                           1.0 / *spec.machine.joints[j].bearing;
                                                     }
                                                   }},
                                         Mechanism{
                                             "link", effects::Effect::link_compliance,
                                             [](simulation::SimulationSpec& spec, Eigen::VectorXd& parameters) {
                                               spec.machine.links.push_back({1, 5e6, 4e6, std::nullopt, std::nullopt});
                                               parameters[2] = 1.0 / 5e6, parameters[3] = 1.0 / 4e6;
                                             }},
                                         Mechanism{"base", effects::Effect::base_compliance,
                                                   [](simulation::SimulationSpec& spec, Eigen::VectorXd& parameters) {
                                                     spec.machine.base_rotation = Eigen::Vector3d(3e7, 2.5e7, 1e15);
                                                     parameters[0] = 1.0 / 3e7, parameters[1] = 1.0 / 2.5e7;
                                                   }}),
                         [](const testing::TestParamInfo<Mechanism>& info) { return info.param.name; });

}  // namespace elastic_arm_test
}  // namespace stiffscope
