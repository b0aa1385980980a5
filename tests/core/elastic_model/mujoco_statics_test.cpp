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

struct Day {
  extended_model::ExtendedModel model;
  const identification::MethodResult& method() const { return model.with.of(identification::bestMethod(model.with)); }
};

std::array<Eigen::Matrix3d, 7> inertiasOfSample() {
  const std::string file = STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf";
  return robot::bodyInertias(io::readTextFile(file, io::kLargestXml), file, "base_link", "tool0");
}

/// Largest |MuJoCo's move - predicted move| of P_TCP and the reflectors, over the predicted move of that point, a row a
/// posture.
std::vector<double> differences(const campaign::Campaign& campaign, const identification::MethodResult& method,
                                const identification::Identification& result,
                                std::vector<effects::PresentEffect> effects, const effects::EffectDeflection* give) {
  elastic_model::ElasticSource source{campaign, method.geometry, method.estimate, result.frames.tcp_in_flange};
  source.effects = std::move(effects);
  source.inertias = inertiasOfSample();
  MujocoArm arm(elastic_model::mjcf(elastic_model::elasticModel(source).chain, {}));
  std::vector<compensation::PostureToCompensate> postures = compensation::campaignPostures(campaign, result.step);
  postures.resize(std::min(postures.size(), kPostures));
  const std::vector<compensation::CompensatedPosture> predicted = compensation::compensate(
      campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, postures, {}, give);
  const Eigen::Matrix3d r0_from_world = method.geometry.r0_from_base_link.linear();
  std::vector<std::string> points{"tcp"};
  for (const campaign::Target& target : campaign.targets) points.push_back(target.id);
  std::vector<double> rows;
  for (const compensation::CompensatedPosture& one : predicted) {
    EXPECT_TRUE(one.predicted);
    arm.stand(campaign.robot.joint_names, one.posture.q);
    EXPECT_TRUE(arm.settle());
    std::vector<Eigen::Vector3d> unloaded;
    for (const std::string& point : points) unloaded.push_back(arm.place(point));
    const Eigen::Matrix3d cell = arm.axes("load_point");
    EXPECT_TRUE(arm.settle("load_point",
                           {cell * one.posture.wrench_in_cell.head<3>(), cell * one.posture.wrench_in_cell.tail<3>()}));
    double worst = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d own = r0_from_world * (arm.place(points[p]) - unloaded[p]);
      const Eigen::Vector3d& theirs = p == 0 ? one.tcp.deflection : one.targets[p - 1].deflection;
      worst = std::max(worst, (own - theirs).norm() / theirs.norm());
    }
    rows.push_back(worst);
  }
  return rows;
}

std::vector<double> differences(const extended_model::ExtendedModel& model) {
  const identification::Method method = identification::bestMethod(model.with);
  const effects::EffectDeflection give = extended_model::effectDeflection(model, method);
  return differences(model.campaign, model.with.of(method), model.with,
                     extended_model::machineEffects(model.effects, model.effects.parameters()), &give);
}

void expectSmall(const std::vector<double>& rows, double most) {
  EXPECT_EQ(rows.size(), kPostures);
  std::string text;
  for (const double row : rows) text += fmt::format(" {:.2e}", row);
  std::printf("%s\n", text.c_str());
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_LT(rows[k], most) << "posture " << k + 1;
}

TEST(MujocoStatics, SpringsAloneMoveAsPredicted) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(5));
  const identification::Identification result = identification::identify(campaign, fewSubsets(20));
  const identification::MethodResult& method = result.of(identification::bestMethod(result));
  expectSmall(differences(campaign, method, result, {}, nullptr), 1e-6);
}

TEST(MujocoStatics, BearingsMoveAsPredicted) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.wrist_sweep->readings = 300;
  expectSmall(differences(extendedDay(spec, {"bearing_tilt"}, 20)), 1e-2);
}

TEST(MujocoStatics, BeamsMoveAsPredicted) {
  simulation::SimulationSpec spec = springsAlone(6);
  for (int joint = 0; joint < 4; ++joint)
    spec.machine.links.push_back({.joint = joint, .bending = 2e7, .torsion = 2e7});
  expectSmall(differences(extendedDay(spec, {"link_compliance"}, 20)), 1e-2);
}

TEST(MujocoStatics, ABaseMovesAsPredicted) {
  simulation::SimulationSpec spec = springsAlone(7);
  spec.machine.base_rotation = Eigen::Vector3d(2e7, 3e7, 1e12);
  spec.machine.base_translation = Eigen::Vector3d(3e7, 3e7, 5e7);
  expectSmall(differences(extendedDay(spec, {"base_compliance"}, 20)), 1e-2);
}

TEST(MujocoStatics, AllTogetherMoveAsPredicted) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.wrist_sweep->readings = 300;
  for (int joint = 0; joint < 4; ++joint)
    spec.machine.links.push_back({.joint = joint, .bending = 2e7, .torsion = 2e7});
  spec.machine.base_rotation = Eigen::Vector3d(2e7, 3e7, 1e12);
  spec.machine.base_translation = Eigen::Vector3d(3e7, 3e7, 5e7);
  expectSmall(differences(extendedDay(spec, {"bearing_tilt", "link_compliance", "base_compliance"}, 20)), 1e-2);
}

}  // namespace mujoco_statics_test
}  // namespace stiffscope
#endif
