#include <gtest/gtest.h>

#include <cmath>
#include "core/simulation/read_spec.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

namespace stiffscope {
namespace truth_json_test {

simulation::SimulationSpec sample() {
  return simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
}

std::vector<reports::Json> effectsCalled(const reports::Json& truth, const std::string& id) {
  std::vector<reports::Json> found;
  for (const reports::Json& one : truth["effects"]) {
    if (one["effect"] == id) found.push_back(one);
  }
  return found;
}

// samples/active.xml: stiffness_nm_per_rad 7e6 to 7.9e4, bearings 5e7 to 3e5.
TEST(TruthJson, HasWhatTheSpecificationStates) {
  simulation::SimulationSpec spec = sample();
  spec.machine.joints[5] = {};  // rigid
  const reports::Json truth = reports::truthJson(spec);
  EXPECT_EQ(truth["stiffness_nm_per_rad"], reports::Json({7e6, 5.6e6, 6.3e6, 4.6e5, 3.5e5, nullptr}));
  EXPECT_EQ(truth["compliance_rad_per_nm"][1], 1.0 / 5.6e6);
  EXPECT_EQ(truth["compliance_rad_per_nm"][5], 0.0);
  const auto bearings = effectsCalled(truth, "bearing_tilt");
  ASSERT_EQ(bearings.size(), 5u);
  EXPECT_EQ(bearings[1]["part"], "joint 2");
  EXPECT_EQ(bearings[1]["bearing_nm_per_rad"], 1.6e7);
  EXPECT_EQ(truth["effects"].size(), 5u);
  EXPECT_EQ(truth["noise"]["true_noise_factor"], 1.0);
  EXPECT_EQ(truth["seed"], 20170924);
}

// Every fault of the measurement and every mechanism that is put in comes out, in SI; nothing comes twice.
TEST(TruthJson, NamesEachEffectWithItsParameters) {
  simulation::SimulationSpec spec = sample();
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  EXPECT_TRUE(reports::truthJson(spec)["effects"].empty());
  spec.machine.joints[1].friction = simulation::JointFriction{40.0, 2e6, 3};
  spec.machine.joints[3].backlash = simulation::JointBacklash{2e-4, 0.02};
  spec.machine.joints[2].stages = simulation::JointStages{{100.0}, {4e6, 6e6}};
  spec.machine.links.push_back({1, 2e7, 1e7, std::nullopt, std::nullopt});
  spec.machine.base_rotation = Eigen::Vector3d(1e8, 2e8, 3e8);
  spec.load_cell->place_error = {0.0, 0.02, 0.0};
  spec.station.ramp[1] = 1e-8;
  spec.station.robot_moved = Eigen::Isometry3d(Eigen::AngleAxisd(1e-4, Eigen::Vector3d::UnitZ()));
  spec.targets[2].motion = simulation::TargetMotion{simulation::TargetMotion::Kind::slip, {1e-5, 0.0, 0.0}, 800.0, 0.0};
  const reports::Json truth = reports::truthJson(spec);
  EXPECT_EQ(truth["effects"].size(), 9u);
  EXPECT_EQ(effectsCalled(truth, "hysteresis").at(0)["torque_nm"], 40.0);
  EXPECT_EQ(effectsCalled(truth, "backlash").at(0)["width_rad"], 2e-4);
  EXPECT_EQ(effectsCalled(truth, "joint_hardening").at(0)["stage_stiffness_nm_per_rad"], reports::Json({4e6, 6e6}));
  const reports::Json link = effectsCalled(truth, "link_compliance").at(0);
  EXPECT_EQ(link["bending_nm2"], 2e7);
  EXPECT_TRUE(link["shear_n"].is_null());
  EXPECT_NEAR(link["length_m"].get<double>(), 1.12, 1e-12);  // the upper arm of the samples' URDF
  EXPECT_EQ(effectsCalled(truth, "base_compliance").at(0)["rotation_nm_per_rad"], reports::Json({1e8, 2e8, 3e8}));
  EXPECT_EQ(effectsCalled(truth, "load_point_error").at(0)["offset_m"], reports::Json({0.0, 0.02, 0.0}));
  EXPECT_EQ(effectsCalled(truth, "tracker_drift").at(0)["ramp_m_per_s"][1], 1e-8);
  EXPECT_NEAR(effectsCalled(truth, "frame_error").at(0)["turn_rad"][2].get<double>(), 1e-4, 1e-12);
  EXPECT_EQ(effectsCalled(truth, "target_motion").at(0)["part"], "P12");
}

// samples/unloaded.xml: joints 2 and 3 give, the gear of joint 2 is uneven 17.25 times a turn.
TEST(TruthJson, NamesEffectsOfADayWithoutALoadByItsVocabulary) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/unloaded.xml");
  const reports::Json sample = reports::truthJson(spec);
  ASSERT_EQ(sample["effects"].size(), 1u);
  EXPECT_EQ(effectsCalled(sample, "transmission_error").at(0)["part"], "joint 2");
  EXPECT_EQ(effectsCalled(sample, "transmission_error").at(0)["cycles_per_turn"], 17.25);
  spec.machine.joints[1].angle_wave.reset();
  spec.machine.joints[4].ratio = simulation::JointRatio{1e-4, 3};
  spec.machine.joints[0].lost_motion = simulation::LostMotion{2e-4, {}};
  spec.machine.joints[2].zero_jump = simulation::ZeroJump{1e-4, 60.0};
  spec.machine.joints[3].zero_warming = simulation::ZeroWarming{1e-5, 300.0};
  spec.early_log = simulation::EarlyLog{0.3, JointVector::Constant(6, 0.05)};
  spec.machine.loose_plate = simulation::LoosePlate{};
  spec.machine.growths = {{1, 0.0, 1.0, 1e-5}};
  spec.station.scale_step = 1e-5;
  spec.station.bending = 1e-6;
  spec.station.tracker_moved = Eigen::Isometry3d(Eigen::Translation3d(1e-4, 0, 0));
  spec.station.tracker_moved_s = 500.0;
  spec.targets[0].motion = simulation::TargetMotion{simulation::TargetMotion::Kind::reseated, {1e-5, 0, 0}};
  spec.targets[1].motion = simulation::TargetMotion{simulation::TargetMotion::Kind::rattling, {0, 1e-5, 0}};
  const reports::Json truth = reports::truthJson(spec);
  EXPECT_EQ(truth["effects"].size(), 12u);
  EXPECT_EQ(effectsCalled(truth, "ratio_error").at(0)["of_joint"], 4);
  EXPECT_TRUE(effectsCalled(truth, "backlash").at(0)["friction_nm"].is_null());
  EXPECT_EQ(effectsCalled(truth, "slipped_belt").at(0)["from_s"], 60.0);
  EXPECT_EQ(effectsCalled(truth, "zero_by_temperature").at(0)["part"], "joint 4");
  EXPECT_EQ(effectsCalled(truth, "read_back_error").at(0)["after_s"], 0.3);
  EXPECT_EQ(effectsCalled(truth, "loose_plate").size(), 1u);
  EXPECT_EQ(effectsCalled(truth, "thermal_growth").at(0)["growth_m_per_k"], 1e-5);
  EXPECT_EQ(effectsCalled(truth, "scale_error").at(0)["scale_step"], 1e-5);
  EXPECT_EQ(effectsCalled(truth, "layered_air").size(), 1u);
  EXPECT_EQ(effectsCalled(truth, "frame_error").at(0)["from_s"], 500.0);
  EXPECT_EQ(effectsCalled(truth, "target_motion").at(0)["kind"], "reseated");
  EXPECT_EQ(effectsCalled(truth, "rattling_reflector").at(0)["part"], "P11");
}

// Axis 3 of the true arm is moved out by 2 mm along the upper arm and nothing else is off: that link is 2 mm longer,
// the others and R0 are the nominal ones.
TEST(TruthJson, GeometryIsTheTrueOneInR0) {
  simulation::SimulationSpec spec = sample();
  spec.machine.geometry = {};
  for (auto& error : spec.machine.geometry.listed) error = simulation::AxisError{};
  spec.machine.geometry.listed[2]->offset = {0.0, 0.0, 2e-3};  // the upper arm stands upright at zero
  const reports::Json truth = reports::truthJson(spec);
  for (std::size_t i = 0; i < 5; ++i) {
    const double longer = i == 1 ? 2.0 : 0.0;
    EXPECT_NEAR(truth["links"][i]["length_mm"].get<double>(),
                truth["links"][i]["nominal_length_mm"].get<double>() + longer, 1e-9)
        << i;
    EXPECT_EQ(truth["links"][i]["length_mm"], truth["link_lengths_mm"][i]);
  }
  EXPECT_NEAR(truth["axes"][2]["point_m"][2].get<double>(), 1.122, 1e-12);
  EXPECT_EQ(truth["axes"][0]["direction"], reports::Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(truth["axis_errors"][2]["offset_m"][2], 2e-3);
}

}  // namespace truth_json_test
}  // namespace stiffscope
