#include <gtest/gtest.h>

#ifndef STIFFSCOPE_TEST_MUJOCO
TEST(MujocoStatics, IsNotBuilt) { GTEST_SKIP() << "MuJoCo is not here"; }
#else

#include "core/campaign/read_campaign.h"
#include "core/compensation/compensate.h"
#include "core/elastic_model/elastic_model.h"
#include "core/elastic_model/mjcf.h"
#include "core/extended_model/effect_deflection.h"
#include "core/io/read_file.h"
#include "core/robot/body_inertia.h"
#include "tests/core/elastic_model/mujoco_arm.h"
#include "tests/fixtures/extended_day.h"

namespace stiffscope {
namespace mujoco_statics_test {

// The exported arm in MuJoCo, a load hung on it, against what compensate predicts. Nothing of the program moves or
// loads the arm on MuJoCo's side: the reading goes in in the axes of load_point as they stand unloaded, and sites come
// out.

constexpr std::size_t kPostures = 10;

std::array<Eigen::Matrix3d, 7> inertiasOfSample() {
  const std::string file = STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf";
  return robot::bodyInertias(io::readTextFile(file, io::kLargestXml), file, "base_link", "tool0");
}

/// A day's result as one method has it, with the effects of the machine that are in its model.
struct Predicted {
  const campaign::Campaign& campaign;
  const identification::Identification& result;
  const identification::MethodResult& method;
  std::vector<effects::PresentEffect> effects = {};
  std::optional<effects::EffectDeflection> give = std::nullopt;

  std::string mjcf() const {
    elastic_model::ElasticSource source{campaign, method.geometry, method.estimate, result.frames.tcp_in_flange};
    source.effects = effects;
    source.inertias = inertiasOfSample();
    return elastic_model::mjcf(elastic_model::elasticModel(source).chain, {});
  }

  std::vector<compensation::CompensatedPosture> postures() const {
    std::vector<compensation::PostureToCompensate> asked = compensation::campaignPostures(campaign, result.step);
    asked.resize(std::min(asked.size(), kPostures));
    return compensation::compensate(campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, asked, {},
                                    give ? &*give : nullptr);
  }
};

Predicted predictedBy(const extended_model::ExtendedModel& model) {
  const identification::Method method = identification::bestMethod(model.with);
  return {model.campaign, model.with, model.with.of(method),
          extended_model::machineEffects(model.effects, model.effects.parameters()),
          extended_model::effectDeflection(model, method)};
}

MujocoLoad loadOf(const MujocoArm& arm, const Vector6d& reading) {
  const Eigen::Matrix3d cell = arm.axes("load_point");
  return {cell * reading.head<3>(), cell * reading.tail<3>()};
}

/// Largest |MuJoCo's move - predicted move| of P_TCP and the reflectors, over the predicted move of that point; one a
/// posture. Without `effects` on MuJoCo's side: what leaving them out would do.
std::vector<double> differences(Predicted predicted, bool effects = true) {
  const std::vector<compensation::CompensatedPosture> postures = predicted.postures();
  if (!effects) predicted.effects.clear();
  MujocoArm arm(predicted.mjcf());
  const Eigen::Matrix3d r0_from_world = predicted.method.geometry.r0_from_base_link.linear();
  std::vector<std::string> points{"tcp"};
  for (const campaign::Target& target : predicted.campaign.targets) points.push_back(target.id);
  std::vector<double> rows;
  for (const compensation::CompensatedPosture& one : postures) {
    EXPECT_TRUE(one.predicted);
    arm.stand(predicted.campaign.robot.joint_names, one.posture.q);
    EXPECT_TRUE(arm.settle());
    std::vector<Eigen::Vector3d> unloaded;
    for (const std::string& point : points) unloaded.push_back(arm.place(point));
    EXPECT_TRUE(arm.settle("load_point", loadOf(arm, one.posture.wrench_in_cell)));
    double worst = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d own = r0_from_world * (arm.place(points[p]) - unloaded[p]);
      const Eigen::Vector3d& theirs = p == 0 ? one.tcp.deflection : one.targets[p - 1].deflection;
      worst = std::max(worst, (own - theirs).norm() / theirs.norm());
    }
    rows.push_back(worst);
  }
  EXPECT_EQ(rows.size(), kPostures);
  return rows;
}

double largest(const std::vector<double>& rows) { return *std::max_element(rows.begin(), rows.end()); }

// A chain of hinges composes its small turns in an order, the program adds them as vectors; the two differ by half
// their product, and turns reach 3 mrad (the wrist's bearings under their own weight and the load). So much of a
// deflection, and no more, may differ.
constexpr double kSecondOrder = 1e-3;

/// Within the second order, and the effects are felt: without them MuJoCo is off by at least `felt`.
void expectAsPredicted(const char* what, const Predicted& predicted, double felt) {
  ASSERT_FALSE(predicted.effects.empty());
  const std::vector<double> rows = differences(predicted);
  for (std::size_t k = 0; k < rows.size(); ++k)
    testing::Test::RecordProperty(fmt::format("{}_posture_{}", what, k + 1), fmt::format("{:.2e}", rows[k]));
  EXPECT_LT(largest(rows), kSecondOrder);
  EXPECT_GT(largest(differences(predicted, false)), felt);
}

// All machines are the sample's, in its postures, with something else that gives; the first is the sample itself.
constexpr std::uint64_t kSampleSeed = 20170924;

campaign::Campaign sample() { return campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign; }

simulation::SimulationSpec withBearings() {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.wrist_sweep->readings = 300;
  return spec;
}

void addBeams(simulation::SimulationSpec& spec) {
  for (int joint = 0; joint < 4; ++joint)
    spec.machine.links.push_back({.joint = joint, .bending = 2e7, .torsion = 2e7, .shear = {}, .axial = {}});
}

void addBase(simulation::SimulationSpec& spec) {
  spec.machine.base_rotation = Eigen::Vector3d(2e7, 3e7, 1e12);
  spec.machine.base_translation = Eigen::Vector3d(3e7, 3e7, 5e7);
}

// Nothing is neglected here: both turn springs about axes that the arm carries along. What is left is where the two
// stop to iterate (1e-12 rad).
TEST(MujocoStatics, SpringsAloneMoveAsPredicted) {
  const campaign::Campaign campaign = sample();
  const identification::Identification result = identification::identify(campaign, fewSubsets(20));
  const std::vector<double> rows = differences({campaign, result, result.of(identification::bestMethod(result))});
  for (std::size_t k = 0; k < rows.size(); ++k)
    RecordProperty(fmt::format("springs_posture_{}", k + 1), fmt::format("{:.2e}", rows[k]));
  EXPECT_LT(largest(rows), 1e-8);
}

TEST(MujocoStatics, BearingsMoveAsPredicted) {
  const auto model = extendedDay(sample(), {"bearing_tilt"}, 20);
  expectAsPredicted("tilt", predictedBy(model), 0.1);
}

TEST(MujocoStatics, BeamsMoveAsPredicted) {
  simulation::SimulationSpec spec = springsAlone(kSampleSeed);
  addBeams(spec);
  const auto model = extendedDay(spec, {"link_compliance"}, 20);
  expectAsPredicted("bending", predictedBy(model), 0.1);
}

TEST(MujocoStatics, ABaseMovesAsPredicted) {
  simulation::SimulationSpec spec = springsAlone(kSampleSeed);
  addBase(spec);
  const auto model = extendedDay(spec, {"base_compliance"}, 20);
  expectAsPredicted("base", predictedBy(model), 0.1);
}

TEST(MujocoStatics, APlateMovesAsPredicted) {
  simulation::SimulationSpec spec = springsAlone(kSampleSeed);
  spec.machine.tool_plate = {.translation = Eigen::Vector3d(5e7, 5e7, 8e7), .rotation = Eigen::Vector3d(2e5, 3e5, 4e5)};
  const auto model = extendedDay(spec, {"tool_compliance"}, 20);
  expectAsPredicted("plate", predictedBy(model), 0.1);
}

TEST(MujocoStatics, AllTogetherMoveAsPredicted) {
  simulation::SimulationSpec spec = withBearings();
  addBeams(spec);
  addBase(spec);
  const auto model = extendedDay(spec, {"bearing_tilt", "link_compliance", "base_compliance"}, 20);
  expectAsPredicted("together", predictedBy(model), 0.1);
}

// A machine ten times as stiff, springs and bearings, is to differ by a tenth of its deflection's share.
TEST(MujocoStatics, WhatDiffersIsOfSecondOrder) {
  auto model = extendedDay(sample(), {"bearing_tilt"}, 20);
  const double soft = largest(differences(predictedBy(model)));
  model.effects.fit.set.effects *= 0.1;
  for (identification::MethodResult& method : model.with.methods) {
    method.estimate.compliance *= 0.1;
    method.geometry.compliance *= 0.1;
  }
  const double stiff = largest(differences(predictedBy(model)));
  EXPECT_GT(soft, 1e-5);
  EXPECT_NEAR(stiff / soft, 0.1, 0.02);
}

// The file as it is, in MuJoCo's own time steps: it falls to rest where its springs are in balance, but for what the
// drives' position control gives.
TEST(MujocoStatics, TheModelFallsToRestInTimeSteps) {
  const auto model = extendedDay(sample(), {"bearing_tilt"}, 20);
  const Predicted predicted = predictedBy(model);
  const compensation::CompensatedPosture one = predicted.postures()[2];
  MujocoArm arm(predicted.mjcf());
  const auto& names = predicted.campaign.robot.joint_names;
  arm.stand(names, one.posture.q);
  ASSERT_TRUE(arm.settle());
  const Eigen::Vector3d unloaded = arm.place("tcp");
  const MujocoLoad load = loadOf(arm, one.posture.wrench_in_cell);
  ASSERT_TRUE(arm.settle("load_point", load));
  const Eigen::Vector3d balance = arm.place("tcp");

  mjModel& m = arm.model();
  mjData& d = arm.data();
  arm.stand(names, one.posture.q);
  for (std::size_t j = 0; j < 6; ++j)
    d.ctrl[mj_name2id(&m, mjOBJ_ACTUATOR, ("drive_" + names[j]).c_str())] = one.posture.q[static_cast<Eigen::Index>(j)];
  const int place = arm.site("load_point");
  constexpr int kSteps = 8000;  // 8 s: the lowest mode, some 8 Hz, damps by 5 % of a turn
  for (int step = 0; step < kSteps; ++step) {
    mju_zero(d.qfrc_applied, m.nv);
    mj_applyFT(&m, &d, load.force.data(), load.moment.data(), d.site_xpos + 3 * place, m.site_bodyid[place],
               d.qfrc_applied);
    mj_step(&m, &d);
  }
  EXPECT_LT(Eigen::Map<const Eigen::VectorXd>(d.qvel, m.nv).cwiseAbs().maxCoeff(), 1e-5);  // rad/s
  EXPECT_LT((arm.place("tcp") - balance).norm(), 2.0 / elastic_model::kDriveGain * (balance - unloaded).norm());
}

}  // namespace mujoco_statics_test
}  // namespace stiffscope
#endif
