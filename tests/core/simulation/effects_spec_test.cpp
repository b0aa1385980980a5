#include <filesystem>
#include <fstream>
#include "core/io/input_error.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

namespace fs = std::filesystem;
using namespace simulation;
using Eigen::Vector3d;

namespace effects_spec_test {

constexpr double kDegree = simulation_test::kDeg;

/// Specifications of one short text, to which an element is added.
class SimulationEffectsSpec : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() /
                    ("stiffscope_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));

  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy_file(fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "m900ib700.urdf", folder / "m900ib700.urdf");
  }
  void TearDown() override { fs::remove_all(folder); }

  /// `added` in the root, the others inside their elements.
  simulation::SimulationSpec read(const std::string& added, const std::string& in_joint = "",
                                  const std::string& joint_attributes = "stiffness_nm_per_rad='3e6'",
                                  const std::string& in_target = "", const std::string& in_load = "",
                                  const std::string& cell = "") {
    std::ofstream(folder / "spec.xml", std::ios::binary)
        << "<simulation format='1' name='n' date='2026-01-01' seed='1'>\n"
           "<robot urdf='m900ib700.urdf' base_link='base_link' flange_link='tool0'/>\n"
           "<joints><joint index='2' "
        << joint_attributes << ">" << in_joint
        << "</joint><joint index='3' stiffness_nm_per_rad='2e6'/></joints>\n"
           "<targets><target id='A' xyz_mm='1 2 3'>"
        << in_target << "</target></targets><tracker model='t' xyz_mm='4000 0 1000' rpy_deg='0 0 0'/>\n"
        << "<load_cell parent='tool0' force_sigma_n='1' moment_sigma_nm='1' " << cell << "/>\n"
        << "<hanging_load masses_kg='50' hook_mm='0 0 100'>" << in_load << "</hanging_load>"
        << "<postures><posture q_deg='0 0 0 0 45 0'/></postures>\n"
        << added << "</simulation>";
    return simulation::readSimulationSpec(folder / "spec.xml");
  }

  std::string complaint(const std::string& added, const std::string& in_joint = "",
                        const std::string& joint_attributes = "stiffness_nm_per_rad='3e6'",
                        const std::string& in_target = "", const std::string& in_load = "") {
    try {
      read(added, in_joint, joint_attributes, in_target, in_load);
    } catch (const io::InputError& error) {
      EXPECT_GT(error.place().line, 0u);
      const std::string text = error.what();
      return text.substr(text.find(": ") + 2);
    }
    return "no complaint";
  }
};

TEST_F(SimulationEffectsSpec, readsWhatAJointHas) {
  const simulation::SimulationSpec spec =
      read("",
           "<stages torques_nm='100 300' stiffness_nm_per_rad='1e6 2e6 3e6'/><backlash width_deg='0.02'/>"
           "<friction torque_nm='80' stiffness_nm_per_rad='4e5' sliders='3'/>"
           "<stiffness_ripple share='0.1' cycles='3' phase_deg='90'/>"
           "<angle_error amplitude_deg='0.01'/><softening share='0.2' time_constant_s='5000'/>"
           "<gear stiffness_nm_per_rad='4e6' lost_motion_deg='0.01' encoder_sigma_deg='0.0002'/>",
           "stiffness_nm_per_rad='3e6' cubic_nm_per_rad3='1e12'");
  const simulation::JointStiffness& joint = spec.machine.joints[1];
  EXPECT_EQ(joint.cubic, 1e12);
  EXPECT_EQ(joint.stages->rates, (std::vector<double>{1e6, 2e6, 3e6}));
  EXPECT_NEAR(joint.backlash->width, 0.02 * kDegree, 1e-18);
  EXPECT_EQ(joint.backlash->rest, 0.001);
  EXPECT_EQ(joint.friction->sliders, 3);
  EXPECT_NEAR(joint.rate_wave->phase, 90 * kDegree, 1e-15);
  EXPECT_EQ(joint.angle_wave->cycles, 1.0);
  EXPECT_EQ(joint.softening->time_constant, 5000.0);
  EXPECT_EQ(joint.gear->stiffness, 4e6);
  EXPECT_NEAR(joint.gear->lost_motion, 0.01 * kDegree, 1e-18);
  EXPECT_NEAR(joint.gear->encoder_sigma, 0.0002 * kDegree, 1e-18);
  EXPECT_EQ(joint.gear->encoder_offset, 0.0);
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  ASSERT_EQ(machine.curves.size(), 1u);
  EXPECT_EQ(machine.curves[0].curve.positive.size(), 4u);  // the gap, then three stages
  EXPECT_EQ(machine.sliderCount(), 3);
  EXPECT_EQ(machine.curves[0].curve.sliders[2].limit, 40.0);  // 1 : 2 : 3 of 80 Nm
}

TEST_F(SimulationEffectsSpec, readsGasAndWhatIsDeclared) {
  const std::string ends = "<spring from_body='1' to_body='2' from_mm='0 0 900' to_mm='300 0 1400' ";
  const simulation::SimulationSpec spec =
      read(ends +
           "gas_pressure_bar='150' gas_area_cm2='17' gas_volume_l='6' gas_exponent='1.2' gas_acts='pull' "
           "declared='true'/>" +
           ends + "tension_n='1e4'/>");
  const simulation::LinkSpring& spring = spec.machine.link_springs.at(0);
  EXPECT_NEAR(spring.gas->pressure, 150e5, 1e-6);
  EXPECT_NEAR(spring.gas->area, 17e-4, 1e-15);
  EXPECT_NEAR(spring.gas->volume, 6e-3, 1e-15);
  EXPECT_EQ(spring.gas->exponent, 1.2);
  EXPECT_FALSE(spring.gas->pushes);
  EXPECT_TRUE(spring.declared);
  EXPECT_FALSE(spec.machine.link_springs.at(1).declared || spec.machine.link_springs.at(1).gas);
  EXPECT_NE(complaint(ends + "gas_pressure_bar='150'/>").find("gas_area_cm2"), std::string::npos);
  const std::string whole = ends + "gas_pressure_bar='150' gas_area_cm2='17' gas_volume_l='6' ";
  EXPECT_NE(complaint(whole + "gas_acts='draw'/>").find("gas_acts: 'draw'"), std::string::npos);
  EXPECT_NE(complaint(whole + "gas_acts='push' gas_exponent='0.9'/>").find("expected 1 or more"), std::string::npos);
  EXPECT_NE(complaint(whole + "gas_acts='push' tension_n='1' declared='true'/>").find("expected gas without"),
            std::string::npos);
}

TEST_F(SimulationEffectsSpec, readsWhatTheMachineHas) {
  const simulation::SimulationSpec spec = read(
      "<base rotation_nm_per_rad='1e7 1e7 1e7' translation_n_per_m='1e9 1e9 1e9'>"
      "<contact axis='y' side='negative' stiffness_nm_per_rad='2e7' gap_deg='0.001'/></base>"
      "<tool_plate translation_n_per_m='1e8 1e8 1e8' rotation_nm_per_rad='1e6 2e6 3e6'/>"
      "<coupling joints='2 3' rod_n_per_m='2e7' crank_mm='300 -250'/>"
      "<coupling joints='3 2' shaft_nm_per_rad='1e5' ratios='1 0.5'/>"
      "<spring from_body='1' to_body='2' from_mm='0 0 900' to_mm='300 0 1400' rate_n_per_m='2e4' "
      "tension_n='1e4'/>"
      "<growth after_joint='4' growth_mm='0.4' time_constant_s='7000'/><creep share='0.1' "
      "time_constant_s='40'/>"
      "<station><drift ramp_mm_per_h='0.1 0 0' walk_deg_per_sqrt_h='0 0 0.001'/>"
      "<tracker_moved xyz_mm='1 0 0'/><robot_moved rpy_deg='0 0 1'/>"
      "<refraction scale_ppm='2' scale_ppm_per_h='3.6'/></station>"
      "<nests after_sweeps='true'/>",
      "", "stiffness_nm_per_rad='3e6'", "<motion kind='slip' shift_um='10 0 5' at_n='300'/>",
      "<swing angle_deg='1' period_s='2'/>", "true_place_error_mm='1 2 3' unread_force_n='0 0 -40'");
  const simulation::MachineSpec& machine = spec.machine;
  EXPECT_EQ(machine.base_contacts.at(0).axis, 1);
  EXPECT_FALSE(machine.base_contacts.at(0).positive);
  EXPECT_EQ(machine.tool_plate->rotation, Vector3d(1e6, 2e6, 3e6));
  EXPECT_EQ(machine.shared_springs.at(0).joints, (std::array<int, 2>{1, 2}));
  EXPECT_NEAR(machine.shared_springs.at(0).arms[1], -0.25, 1e-16);
  EXPECT_EQ(machine.shared_springs.at(1).joints, (std::array<int, 2>{2, 1}));
  EXPECT_NEAR(machine.link_springs.at(0).to_in_base_at_zero.z(), 1.4, 1e-15);
  EXPECT_EQ(machine.growths.at(0).joint, 3);
  EXPECT_EQ(machine.creep->share, 0.1);
  EXPECT_NEAR(spec.station.ramp[0], 1e-4 / 3600, 1e-20);
  EXPECT_NEAR(spec.station.walk[5], 0.001 * kDegree / 60, 1e-18);
  EXPECT_NEAR(spec.station.tracker_moved->translation().x(), 1e-3, 1e-18);
  EXPECT_TRUE(spec.station.robot_moved);
  EXPECT_NEAR(spec.station.scale_per_second, 1e-9, 1e-22);
  EXPECT_TRUE(spec.nests_after_sweeps);
  EXPECT_EQ(spec.targets[0].motion->kind, simulation::TargetMotion::Kind::slip);
  EXPECT_NEAR(spec.targets[0].motion->shift.x(), 1e-5, 1e-18);
  EXPECT_EQ(spec.loading->swing_period, 2.0);
  EXPECT_LT((spec.load_cell->place_error - Vector3d(0.001, 0.002, 0.003)).norm(), 1e-16);
  EXPECT_EQ(spec.load_cell->unread_force, Vector3d(0, 0, -40));
}

TEST_F(SimulationEffectsSpec, refusesWhatAJointCannotHave) {
  const auto about = [&](const std::string& in_joint) { return complaint("", in_joint); };
  EXPECT_EQ(about("<stages torques_nm='300 100' stiffness_nm_per_rad='1 2 3'/>"),
            "torques_nm: '300 100': expected rising numbers above 0");
  EXPECT_EQ(about("<stages torques_nm='100' stiffness_nm_per_rad='1e6'/>"),
            "stiffness_nm_per_rad: '1e6': expected 2 numbers separated by blanks");
  EXPECT_EQ(about("<stages torques_nm='100' stiffness_nm_per_rad='1e6 0'/>"),
            "stiffness_nm_per_rad: '1e6 0': expected numbers above 0, one more than torques_nm has");
  EXPECT_EQ(about("<backlash width_deg='0'/>"), "width_deg: '0': expected a number above 0");
  EXPECT_EQ(about("<backlash width_deg='1' rest_share='2'/>"),
            "rest_share: '2': expected a share of the stiffness, at most 1");
  EXPECT_EQ(about("<friction torque_nm='8' stiffness_nm_per_rad='1e5' sliders='0'/>"),
            "sliders: '0': expected a whole number from 1 to 100");
  EXPECT_EQ(about("<stiffness_ripple share='1'/>"), "share: '1': expected a share between -1 and 1");
  EXPECT_EQ(about("<angle_eror amplitude_deg='1'/>"),
            "angle_eror: expected an element that 'joint' has (did you mean 'angle_error'?)");
  EXPECT_EQ(complaint("", "<backlash width_deg='1'/>", "bearing_nm_per_rad='1e6'"),
            "stiffness_nm_per_rad: expected a stiffness: this joint's other elements build on it");
}

TEST_F(SimulationEffectsSpec, refusesWhatTheMachineCannotHave) {
  EXPECT_EQ(complaint("<coupling joints='2 2' shaft_nm_per_rad='1' ratios='1 1'/>"),
            "joints: '2 2': expected two different joints from 1 to 6");
  EXPECT_EQ(complaint("<coupling joints='2 5' shaft_nm_per_rad='1' ratios='1 1'/>"),
            "joints: '2 5': expected joints that have stiffness_nm_per_rad");
  EXPECT_EQ(complaint("<coupling joints='2 3' crank_mm='1 1'/>"),
            "coupling: expected rod_n_per_m with crank_mm, or shaft_nm_per_rad with ratios");
  EXPECT_EQ(complaint("<spring from_body='2' to_body='1' from_mm='0 0 0' to_mm='0 0 9'/>"),
            "to_body: '1': expected a body beyond from_body");
  EXPECT_EQ(complaint("<spring from_body='1' to_body='2' from_mm='0 0 0' to_mm='0 0 0.5'/>"),
            "to_mm: '0 0 0.5': expected a point at least 1 mm from from_mm");
  EXPECT_EQ(complaint("<base><contact axis='x' side='positive' stiffness_nm_per_rad='1'/></base>"),
            "contact: expected rotation_nm_per_rad of the base beside it");
  EXPECT_EQ(complaint("<tool_plate translation_n_per_m='1 1 0' rotation_nm_per_rad='1 1 1'/>"),
            "translation_n_per_m: '1 1 0': expected three numbers above 0");
  EXPECT_EQ(complaint("<growth after_joint='6' growth_mm='1' time_constant_s='1'/>"),
            "after_joint: '6': expected a whole number from 1 to 5");
  EXPECT_EQ(complaint("<creep share='1.5' time_constant_s='1'/>"), "share: '1.5': expected a share, at most 1");
}

TEST_F(SimulationEffectsSpec, refusesWhatADayCannotHave) {
  EXPECT_EQ(complaint("<station><drift walk_mm_per_sqrt_h='0 -1 0'/></station>"),
            "walk_mm_per_sqrt_h: '0 -1 0': expected three numbers not below 0");
  EXPECT_EQ(complaint("<station><tracker_moved/></station>"), "tracker_moved: expected xyz_mm or rpy_deg");
  EXPECT_EQ(complaint("", "", "stiffness_nm_per_rad='3e6'", "<motion kind='slips' shift_um='1 0 0' at_n='1'/>"),
            "kind: 'slips': expected one of proportional, slip, compliant, reseated, rattling (did you mean 'slip'?)");
  EXPECT_EQ(complaint("", "", "stiffness_nm_per_rad='3e6'", "<motion kind='slip' shift_um='1 0 0' at_n='0'/>"),
            "at_n: '0': expected a number above 0");
  EXPECT_EQ(complaint("", "", "stiffness_nm_per_rad='3e6'", "", "<swing angle_deg='1' period_s='0'/>"),
            "period_s: '0': expected a number above 0");
}

}  // namespace effects_spec_test

}  // namespace stiffscope
