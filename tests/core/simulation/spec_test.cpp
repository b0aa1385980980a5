#include <filesystem>
#include <fstream>
#include <sstream>
#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/io/input_error.h"
#include "core/simulation/postures.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

namespace fs = std::filesystem;
using Eigen::Vector3d;

namespace spec_test {

const fs::path kSamples = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples";

std::string bytesOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class SimulationSpecFile : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() /
                    ("stiffscope_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));

  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy_file(kSamples / "m900ib700.urdf", folder / "m900ib700.urdf");
  }
  void TearDown() override { fs::remove_all(folder); }

  /// The sample with its first `from` replaced by `to`, read.
  simulation::SimulationSpec readWith(const std::string& from, const std::string& to) {
    std::string text = bytesOf(kSamples / "inactive.xml");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(folder / "spec.xml", std::ios::binary) << text;
    return simulation::readSimulationSpec(folder / "spec.xml");
  }

  /// What readWith has to say against it, after the file's name.
  std::string complaint(const std::string& from, const std::string& to) {
    try {
      readWith(from, to);
    } catch (const io::InputError& error) {
      EXPECT_EQ(error.place().file, (folder / "spec.xml").string());
      EXPECT_GT(error.place().line, 0u);
      const std::string text = error.what();
      return text.substr(text.find(": ") + 2);
    }
    return "no complaint";
  }
};

// A gear is what lies between the motor and a second encoder.
TEST_F(SimulationSpecFile, aJointWithAGearHasADoubleEncoder) {
  const std::string text = bytesOf(kSamples / "inactive.xml");
  const std::size_t at = text.find("<joint index=\"4\"");
  const std::string joint = text.substr(at, text.find("/>", at) + 2 - at);
  const std::string with_gear = joint.substr(0, joint.size() - 2) + "><gear stiffness_nm_per_rad=\"1e6\"/></joint>";
  EXPECT_EQ(complaint(joint, with_gear), "double_encoder_joints: '1 2 3': expected joint 4 among them: it has a gear");
  EXPECT_EQ(complaint("double_encoder_joints=\"1 2 3\"", "double_encoder_joints=\"1 2 7\""),
            "double_encoder_joints: '7': expected a joint's number, 1 to 6");
}

TEST_F(SimulationSpecFile, aJointLeftOutIsRigidAndNamed) {
  EXPECT_TRUE(simulation::rigidJoints(simulation::readSimulationSpec(kSamples / "inactive.xml")).empty());
  const std::string text = bytesOf(kSamples / "inactive.xml");
  const std::size_t at = text.find("<joint index=\"4\"");
  const std::string joint = text.substr(at, text.find("/>", at) + 2 - at);
  EXPECT_EQ(simulation::rigidJoints(readWith(joint, "")), std::vector<int>{4});
  EXPECT_EQ(simulation::rigidJoints(readWith(joint, "<joint index=\"4\" bearing_nm_per_rad=\"2e6\"/>")),
            std::vector<int>{4});
}

TEST(SimulationSpec, samplesAreOneMachineInTwoStates) {
  const simulation::SimulationSpec inactive = simulation::readSimulationSpec(kSamples / "inactive.xml");
  const simulation::SimulationSpec active = simulation::readSimulationSpec(kSamples / "active.xml");
  EXPECT_EQ(inactive.double_encoder, campaign::DoubleEncoder::inactive);
  EXPECT_EQ(active.double_encoder, campaign::DoubleEncoder::active);
  EXPECT_EQ(active.double_encoder_joints, (std::vector<int>{0, 1, 2}));  // the paper's "3 first axis"
  EXPECT_EQ(inactive.seed, active.seed);
  EXPECT_NE(inactive.measurement, active.measurement);
  // Table II of the paper, rows DPP.
  EXPECT_DOUBLE_EQ(*inactive.machine.joints[1].torsion, 3.2e6);
  EXPECT_DOUBLE_EQ(*active.machine.joints[2].torsion, 6.3e6);
  EXPECT_EQ(simulation::loadingPostures(inactive).size(), 19u);
  for (int p = 0; p < 19; ++p) {
    EXPECT_EQ(simulation::loadingPostures(inactive)[p].q, simulation::loadingPostures(active)[p].q);
  }
  const simulation::ElasticMachine a = simulation::buildMachine(inactive), b = simulation::buildMachine(active);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(a.axis_errors[i].isApprox(b.axis_errors[i], 0.0));
  double moving = inactive.nominal.bodies[1].mass_kg;
  for (int k = 2; k < 7; ++k) moving += inactive.nominal.bodies[k].mass_kg;
  EXPECT_NEAR(moving + 700.0, 2800.0, 1e-9);
  // The dimensions the arm is named for.
  const Vector3d flange = inactive.nominal.base_from_flange_at_zero.translation();
  EXPECT_LT((flange - Vector3d(0.41 + 1.285 + 0.3, 0, 0.94 + 1.12 + 0.25)).norm(), 1e-12);
}

TEST_F(SimulationSpecFile, aSampleSurvivesWritingAndReading) {
  const simulation::SimulationSpec spec = simulation::readSimulationSpec(kSamples / "inactive.xml");
  const campaign::Campaign campaign = simulation::simulate(spec);
  EXPECT_EQ(campaign.wrist_sweep->rows.size(), 1000u);
  campaign::writeCampaign(campaign, spec.urdf_file, folder / "a");
  campaign::writeCampaign(simulation::simulate(spec), spec.urdf_file, folder / "b");
  for (const auto& entry : fs::directory_iterator(folder / "a")) {
    EXPECT_EQ(bytesOf(entry.path()), bytesOf(folder / "b" / entry.path().filename())) << entry.path();
  }
  const campaign::CampaignReading reading = campaign::readCampaign(folder / "a");
  EXPECT_TRUE(reading.warnings.empty());
  const campaign::Campaign& read = reading.campaign;
  ASSERT_EQ(read.loading->rows.size(), campaign.loading->rows.size());
  for (std::size_t r = 0; r < read.loading->rows.size(); ++r) {
    // Files carry 0.1 um.
    EXPECT_LT((read.loading->rows[r].point - campaign.loading->rows[r].point).cwiseAbs().maxCoeff(), 5.1e-8);
  }
  EXPECT_EQ(read.pose_ids, campaign.pose_ids);
}

TEST_F(SimulationSpecFile, readsEveryOtherEffect) {
  const simulation::SimulationSpec spec = readWith(
      "<geometry position_sigma_mm=\"0.2\" direction_sigma_deg=\"0.02\" zero_sigma_deg=\"0.02\" "
      "wrist_position_sigma_mm=\"0.02\"/>",
      "<base rotation_nm_per_rad='1e7 2e7 3e7' tilt_deg='90' tilt_azimuth_deg='0' tilt_declared='true'/>"
      "<link after_joint='4' bending_nm2='6e6' torsion_nm2='4e6' shear_n='4e8'/>"
      "<geometry><axis index='3' offset_mm='1 2 3' tilt_deg='0 0 9' zero_deg='0.5'/></geometry>");
  EXPECT_EQ(*spec.machine.base_rotation, Vector3d(1e7, 2e7, 3e7));
  EXPECT_EQ(spec.machine.links.at(0).joint, 3);
  EXPECT_FALSE(spec.machine.links.at(0).axial);
  EXPECT_LT((spec.machine.geometry.listed[2]->offset - Vector3d(0.001, 0.002, 0.003)).norm(), 1e-18);
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  EXPECT_EQ(machine.coordinateCount(), 3 + 6 * 3 + 5);
  // base_link turned by +90 deg about its x axis: what was up, z, now lies; gravity is along -y.
  EXPECT_LT((machine.gravity_in_base - Vector3d(0, -9.80665, 0)).norm(), 1e-14);
  EXPECT_NEAR(machine.zeros[2], 0.5 * simulation_test::kDeg, 1e-16);
}

TEST_F(SimulationSpecFile, refusesWhatItDoesNotUnderstand) {
  EXPECT_EQ(complaint("bearing_nm_per_rad=\"5e7\"", "bearing_nm_pr_rad=\"5e7\""),
            "bearing_nm_pr_rad: '5e7': expected an attribute that 'joint' has (did you mean "
            "'bearing_nm_per_rad'?)");
  EXPECT_EQ(complaint("<times ", "<time "), "time: expected an element that 'simulation' has (did you mean 'times'?)");
  EXPECT_EQ(complaint("seed=\"20170924\"", "seed=\"-1\""),
            "seed: '-1': expected a whole number from 0 to 18446744073709551615");
  EXPECT_EQ(complaint("stiffness_nm_per_rad=\"4.0e6\"", "stiffness_nm_per_rad=\"0\""),
            "stiffness_nm_per_rad: '0': expected a number above 0");
  EXPECT_EQ(complaint("scheme=\"one_target\"", "scheme=\"one_targt\""),
            "scheme: 'one_targt': expected one of one_target, all_targets (did you mean 'one_target'?)");
  EXPECT_EQ(complaint("parent=\"tool0\"", "parent=\"tool1\""),
            "parent: 'tool1': expected a link of the robot's chain (did you mean 'tool0'?)");
  EXPECT_EQ(complaint("<joint index=\"2\"", "<joint index=\"1\""), "index: '1': expected every joint at most once");
  EXPECT_EQ(complaint("max_deg=\"50 55 30 120 100 150\"", "max_deg=\"50 55 30 120 100\""),
            "max_deg: '50 55 30 120 100': expected 6 numbers separated by blanks");
  EXPECT_EQ(complaint("masses_kg=\"51 102 153\"", "masses_kg=\"0 51 102 153\""),
            "masses_kg: '0 51 102 153': expected numbers above 0, one a step (the unloaded step 0 and the return "
            "are not listed)");
  EXPECT_EQ(complaint("<hanging_load masses_kg=\"51 102 153\"", "<cable_load tensions_n=\"51 102 153\""),
            "draw: expected a direction: cable_load has neither anchor_mm nor direction");
}

TEST_F(SimulationSpecFile, refusesPosturesBeyondTheLimits) {
  EXPECT_EQ(complaint("<postures>", "<postures><posture q_deg=\"0 0 60 0 45 0\"/>"),
            "q_deg: '0 0 60 0 45 0': expected joint 3 within the limits of the URDF");
}

}  // namespace spec_test

}  // namespace stiffscope
