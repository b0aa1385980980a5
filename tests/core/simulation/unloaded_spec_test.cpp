#include <filesystem>
#include <fstream>
#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/io/input_error.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

namespace fs = std::filesystem;
using namespace simulation;
using Eigen::Vector3d;

namespace unloaded_spec_test {

constexpr double kDegree = simulation_test::kDeg;

/// A day without a load that has everything such a day can have.
const std::string kDay = R"(<simulation format='1' name='n' date='2026-01-01' seed='1'>
<robot urdf='m900ib700.urdf' base_link='base_link' flange_link='tool0'>
<early_log after_s='0.4' time_constant_s='0.1 0.1 0.1 0.1 0.1 0.05'/></robot>
<joints>
<joint index='1'><lost_motion width_deg='0.01'/><zero_jump angle_deg='0.02' at_s='90'/></joint>
<joint index='2'><lost_motion width_deg='0.02' friction_nm='300'/><ratio share='2e-5'/></joint>
<joint index='5'><ratio share='1e-4' of_joint='4'/><zero_warming deg_per_k='0.003' lag_s='60'/></joint>
</joints>
<growth after_joint='2' growth_mm_per_k='0.012'/>
<growth after_joint='3' growth_mm='0.1' time_constant_s='900' growth_mm_per_k='0.02'/>
<temperature times_s='0 100 200' celsius='20 22.5 21'/>
<loose_plate direction='2 0 0' shift_um='10 0 5' turn_deg='0 0.01 0'/>
<targets><target id='A' xyz_mm='1 2 3'><motion kind='reseated' shift_um='0 30 0' at_s='70'/></target>
<target id='B' xyz_mm='9 2 3'><motion kind='rattling' shift_um='0 0 40'/></target></targets>
<tracker model='t' range_fixed_um='4' angle_fixed_um='6' xyz_mm='4000 0 1000' rpy_deg='0 0 0'/>
<station><drift limit_mm='0.1 0 0' limit_deg='0 0.01 0' time_constant_s='700' smooth='true'/>
<tracker_moved xyz_mm='0.2 0 0' at_s='50'/><robot_moved xyz_mm='0 0.3 0' at_s='60'/>
<refraction step_ppm='12' step_at_s='80' bending_urad_per_m='1.5' bending_urad_per_m2='-2'/></station>
<postures repeats='2'><posture q_deg='0 0 0 0 45 0'/><posture q_deg='10 -10 5 0 45 0'/></postures>
</simulation>)";

class SimulationUnloadedSpec : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() /
                    ("stiffscope_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));

  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy_file(fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "m900ib700.urdf", folder / "m900ib700.urdf");
  }
  void TearDown() override { fs::remove_all(folder); }

  /// The day with its first `from` replaced.
  SimulationSpec readWith(const std::string& from = "", const std::string& to = "") {
    std::string text = kDay;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return parseSimulationSpec(text, folder / "spec.xml");
  }

  std::string complaint(const std::string& from, const std::string& to) {
    try {
      readWith(from, to);
    } catch (const io::InputError& error) {
      EXPECT_GT(error.place().line, 0u);
      return error.what();
    }
    return "no complaint";
  }
};

TEST_F(SimulationUnloadedSpec, readsWhatTheMachineDoes) {
  const SimulationSpec spec = readWith();
  EXPECT_FALSE(spec.loading || spec.load_cell);
  EXPECT_EQ(spec.unloaded_repeats, 2);
  EXPECT_DOUBLE_EQ(spec.early_log->after, 0.4);
  EXPECT_DOUBLE_EQ(spec.early_log->time_constants[5], 0.05);
  const auto& joints = spec.machine.joints;
  EXPECT_DOUBLE_EQ(joints[0].lost_motion->width, 0.01 * kDegree);
  EXPECT_FALSE(joints[0].lost_motion->friction);
  EXPECT_DOUBLE_EQ(joints[0].zero_jump->angle, 0.02 * kDegree);
  EXPECT_DOUBLE_EQ(joints[0].zero_jump->from_s, 90.0);
  EXPECT_DOUBLE_EQ(*joints[1].lost_motion->friction, 300.0);
  EXPECT_EQ(joints[1].ratio->of, 1);
  EXPECT_EQ(joints[4].ratio->of, 3);
  EXPECT_DOUBLE_EQ(joints[4].ratio->share, 1e-4);
  EXPECT_DOUBLE_EQ(joints[4].zero_warming->per_kelvin, 0.003 * kDegree);
  EXPECT_DOUBLE_EQ(joints[4].zero_warming->lag, 60.0);
  ASSERT_EQ(spec.machine.growths.size(), 2u);
  EXPECT_DOUBLE_EQ(spec.machine.growths[0].per_kelvin, 1.2e-5);
  EXPECT_EQ(spec.machine.growths[0].growth, 0.0);
  EXPECT_DOUBLE_EQ(spec.machine.growths[1].growth, 1e-4);
  EXPECT_DOUBLE_EQ(spec.machine.growths[1].per_kelvin, 2e-5);
  EXPECT_EQ(spec.machine.loose_plate->direction, Vector3d::UnitX());
  EXPECT_DOUBLE_EQ(spec.machine.loose_plate->shift.z(), 5e-6);
  EXPECT_DOUBLE_EQ(spec.machine.loose_plate->turn.y(), 0.01 * kDegree);
}

TEST_F(SimulationUnloadedSpec, readsWhatTheDayDoes) {
  const SimulationSpec spec = readWith();
  EXPECT_EQ(spec.temperature->celsius, (std::vector<double>{20.0, 22.5, 21.0}));
  EXPECT_EQ(spec.targets[0].motion->kind, TargetMotion::Kind::reseated);
  EXPECT_DOUBLE_EQ(spec.targets[0].motion->from_s, 70.0);
  EXPECT_EQ(spec.targets[1].motion->kind, TargetMotion::Kind::rattling);
  EXPECT_DOUBLE_EQ(spec.targets[1].motion->shift.z(), 4e-5);
  EXPECT_DOUBLE_EQ(spec.station.limit[0], 1e-4);
  EXPECT_DOUBLE_EQ(spec.station.limit[4], 0.01 * kDegree);
  EXPECT_DOUBLE_EQ(spec.station.limit_time, 700.0);
  EXPECT_TRUE(spec.station.smooth);
  EXPECT_DOUBLE_EQ(*spec.station.tracker_moved_s, 50.0);
  EXPECT_DOUBLE_EQ(*spec.station.robot_moved_s, 60.0);
  EXPECT_DOUBLE_EQ(spec.station.scale_step, 12e-6);
  EXPECT_DOUBLE_EQ(spec.station.scale_step_s, 80.0);
  EXPECT_DOUBLE_EQ(spec.station.bending, 1.5e-6);
  EXPECT_DOUBLE_EQ(spec.station.bending_per_m, -2e-6);
}

TEST_F(SimulationUnloadedSpec, refusesWhatSuchADayCannotHave) {
  const std::vector<std::array<std::string, 3>> rows{
      {"repeats='2'", "repeats='0'", "expected a whole number from 1 to 1000"},
      {"times_s='0 100 200'", "times_s='0 100 50'", "expected rising times"},
      {"celsius='20 22.5 21'", "celsius='20 22.5'", "expected 3 numbers"},
      {"<temperature times_s='0 100 200' celsius='20 22.5 21'/>", "", "expected the element temperature beside it"},
      {"0.1 0.1 0.1 0.1 0.1 0.05", "0.1 0.1 0.1 0.1 0.1 0", "expected six numbers above 0"},
      {"of_joint='4'", "of_joint='7'", "expected a whole number from 1 to 6"},
      {"width_deg='0.01'", "width_deg='0'", "expected a number above 0"},
      {"kind='rattling'", "kind='ratling'", "did you mean 'rattling'"},
      {"shift_um='0 30 0' at_s='70'", "shift_um='0 30 0' at_n='70'", "expected an attribute that 'motion' has"},
      {"direction='2 0 0'", "direction='0 0 0'", "expected a direction, not three zeros"},
      {"<postures repeats='2'>", "<hanging_load masses_kg='5' hook_mm='0 0 0'/><postures repeats='2'>",
       "expected none: the load has its repeats"}};
  for (const auto& [from, to, expected] : rows) {
    EXPECT_NE(complaint(from, to).find(expected), std::string::npos) << complaint(from, to) << " for " << to;
  }
}

// As it is written it is read: no wrench, no load cell, the temperature beside each state.
TEST_F(SimulationUnloadedSpec, theCampaignIsReadAsItWasMeasured) {
  const campaign::Campaign made = simulate(readWith());
  campaign::writeCampaign(made, folder / "m900ib700.urdf", folder / "day");
  const campaign::CampaignReading reading = campaign::readCampaign(folder / "day");
  const campaign::Campaign& read = reading.campaign;
  EXPECT_FALSE(read.load_cell || read.tool || read.circle_sweeps || read.wrist_sweep);
  ASSERT_EQ(read.states->rows.size(), 2u);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_NEAR(read.states->rows[r].extras().temperature_c, made.states->rows[r].extras().temperature_c, 0.5e-2);
    EXPECT_LT((read.states->rows[r].q - made.states->rows[r].q).norm(), 1e-6);
  }
  ASSERT_EQ(read.loading->rows.size(), 2u * 2 * 2);
  EXPECT_LT((read.loading->rows[3].point - made.loading->rows[3].point).norm(), 1e-7);
}

}  // namespace unloaded_spec_test

}  // namespace stiffscope
