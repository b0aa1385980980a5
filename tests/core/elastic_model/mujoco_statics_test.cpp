#include <gtest/gtest.h>

#ifndef STIFFSCOPE_TEST_MUJOCO
TEST(MujocoStatics, IsNotBuilt) { GTEST_SKIP() << "MuJoCo is not here"; }
#else

#include <fmt/format.h>
#include <algorithm>

#include "core/campaign/read_campaign.h"
#include "core/compensation/compensate.h"
#include "core/elastic_model/elastic_model.h"
#include "core/elastic_model/simulator_models.h"
#include "core/extended_model/effect_deflection.h"
#include "core/io/read_file.h"
#include "core/robot/body_inertia.h"
#include "tests/core/elastic_model/mujoco_arm.h"
#include "tests/fixtures/extended_day.h"

namespace stiffscope {
namespace mujoco_statics_test {

// The exported arm in MuJoCo, a load hung on it, against what compensate predicts. Nothing of the program moves or
// loads the arm on MuJoCo's side: the reading goes in in the axes of load_point as they stand loaded, and sites come
// out.

constexpr std::size_t kPostures = 10;

PerBody<Eigen::Matrix3d> inertiasOfSample() {
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

  bool reversed = false;  ///< the springs of each body in the other order

  std::string mjcf() const {
    elastic_model::ElasticSource source{campaign, method.geometry, method.estimate, result.frames.tcp_in_flange};
    source.effects = effects;
    source.inertias = inertiasOfSample();
    elastic_model::ElasticChain chain = elastic_model::elasticModel(source).chain;
    for (elastic_model::ChainBody& body : chain.bodies) {
      if (reversed) std::reverse(body.joints.begin(), body.joints.end());
    }
    return elastic_model::mjcf(chain, {});
  }

  std::vector<compensation::PostureToCompensate> asked() const {
    std::vector<compensation::PostureToCompensate> postures = compensation::campaignPostures(campaign, result.step);
    postures.resize(std::min(postures.size(), kPostures));
    return postures;
  }

  std::vector<compensation::CompensatedPosture> postures() const {
    return compensation::compensate(campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, asked(),
                                    {}, give ? &*give : nullptr);
  }
};

Predicted predictedBy(const extended_model::ExtendedModel& model) {
  const identification::Method method = identification::bestMethod(model.with);
  return {model.campaign, model.with, model.with.of(method),
          extended_model::machineEffects(model.effects, model.effects.parameters()),
          extended_model::effectDeflection(model, method)};
}

/// By the axes as they stand now.
MujocoLoad loadOf(const MujocoArm& arm, const Vector6d& reading) {
  const Eigen::Matrix3d cell = arm.axes("load_point");
  return {cell * reading.head<3>(), cell * reading.tail<3>()};
}

/// Of P_TCP and the reflectors, in this order.
using Moves = std::vector<Eigen::Vector3d>;

/// What is to be taken off a place, world axes.
using Neglected = Eigen::Vector3d (*)(const MujocoArm& arm, const Predicted& predicted, const Eigen::Vector3d& point);

/// Moves by the load in MuJoCo, R0 axes, one row a posture.
std::vector<Moves> movesInMujoco(const Predicted& predicted, Neglected neglected = nullptr) {
  MujocoArm arm(predicted.mjcf());
  const Eigen::Matrix3d r0_from_world = predicted.method.geometry.r0_from_base_link.linear();
  std::vector<std::string> points{"tcp"};
  for (const campaign::Target& target : predicted.campaign.targets) points.push_back(target.id);
  const auto place = [&](const std::string& name) -> Eigen::Vector3d {
    const Eigen::Vector3d there = arm.place(name);
    return neglected ? Eigen::Vector3d(there - neglected(arm, predicted, there)) : there;
  };
  std::vector<Moves> rows;
  for (const compensation::PostureToCompensate& posture : predicted.asked()) {
    arm.stand(predicted.campaign.robot.joint_names, posture.q);
    EXPECT_TRUE(arm.settle());
    Moves moves;
    for (const std::string& point : points) moves.push_back(-place(point));
    // The load turns the axes in which it is read: some thousandths, of which each round leaves as much.
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round)
      EXPECT_TRUE(arm.settle("load_point", loadOf(arm, posture.wrench_in_cell)));
    for (std::size_t p = 0; p < points.size(); ++p) moves[p] = r0_from_world * (moves[p] + place(points[p]));
    rows.push_back(moves);
  }
  EXPECT_EQ(rows.size(), kPostures);
  return rows;
}

/// Largest |move - predicted move| of these points, over the predicted move of that point; one a posture.
std::vector<double> differences(const Predicted& predicted, const std::vector<Moves>& moves) {
  std::vector<double> rows;
  for (const compensation::CompensatedPosture& one : predicted.postures()) {
    EXPECT_TRUE(one.predicted);
    const Moves& own = moves[rows.size()];
    double worst = 0.0;
    for (std::size_t p = 0; p < own.size(); ++p) {
      const Eigen::Vector3d& theirs = p == 0 ? one.tcp.deflection : one.targets[p - 1].deflection;
      worst = std::max(worst, (own[p] - theirs).norm() / theirs.norm());
    }
    rows.push_back(worst);
  }
  return rows;
}

std::vector<double> differences(const Predicted& predicted) { return differences(predicted, movesInMujoco(predicted)); }

double largest(const std::vector<double>& rows) { return *std::max_element(rows.begin(), rows.end()); }

// Products of two small turns, which reach 3 mrad (the wrist's bearings under the tool and the load): by half of that
// the two may differ, relatively, and no more. What they are: WhatDiffersIsTheMomentHalfWay.
constexpr double kSecondOrder = 1e-3;

/// Within the second order, and the effects are felt: without them MuJoCo is off by at least `felt`.
void expectAsPredicted(const char* what, const Predicted& predicted, double felt) {
  ASSERT_FALSE(predicted.effects.empty());
  const std::vector<double> rows = differences(predicted);
  for (std::size_t k = 0; k < rows.size(); ++k)
    testing::Test::RecordProperty(fmt::format("{}_posture_{}", what, k + 1), fmt::format("{:.2e}", rows[k]));
  EXPECT_LT(largest(rows), kSecondOrder);
  Predicted without = predicted;
  without.effects.clear();
  EXPECT_GT(largest(differences(predicted, movesInMujoco(without))), felt);
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

/// What the program leaves out of a bearing's tilt, to second order, at a point of the flange. It takes the moment M
/// across the axis z as that stands before the bearing gives, phi = s (M - z z.M). A spring alike in all directions
/// with an energy, s^-1 |phi|^2 / 2, takes it half way: phi + s (z.M) z x phi / 2.
Eigen::Vector3d halfWayTilt(const MujocoArm& arm, const Predicted& predicted, const Eigen::Vector3d& point) {
  Eigen::Vector3d move = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < 6; ++j) {
    const std::string& name = predicted.campaign.robot.joint_names[j];
    const std::string u = name + "_tilt_u", v = name + "_tilt_v";
    const Eigen::Vector3d tilt = arm.position(u) * arm.axis(u) + arm.position(v) * arm.axis(v);
    const double compliance = predicted.effects[0].parameters[static_cast<Eigen::Index>(j)];
    const Eigen::Vector3d more = 0.5 * compliance * arm.torque(name) * arm.axis(name).cross(tilt);
    move += more.cross(point - arm.anchor(u));
  }
  return move;
}

// Two hinges one after the other compose a tilt in an order; the mean of both orders is a vector's. What is left then
// is what halfWayTilt says.
TEST(MujocoStatics, WhatDiffersIsTheMomentHalfWay) {
  const auto model = extendedDay(sample(), {"bearing_tilt"}, 20);
  Predicted predicted = predictedBy(model);
  ASSERT_EQ(predicted.effects.size(), 1u);
  const double as_it_is = largest(differences(predicted));
  auto moves = movesInMujoco(predicted, &halfWayTilt);
  predicted.reversed = true;
  const auto reversed = movesInMujoco(predicted, &halfWayTilt);
  for (std::size_t k = 0; k < moves.size(); ++k) {
    for (std::size_t p = 0; p < moves[k].size(); ++p) moves[k][p] = 0.5 * (moves[k][p] + reversed[k][p]);
  }
  EXPECT_LT(largest(differences(predicted, moves)), 0.1 * as_it_is);
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
