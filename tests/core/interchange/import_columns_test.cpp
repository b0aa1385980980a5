#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/interchange/import_day.h"
#include "tests/core/interchange/refusal.h"

// Days of a few rows in tables of one's own, and what of them reaches the campaign.

namespace stiffscope {
namespace import_columns_test {

namespace fs = std::filesystem;
using namespace interchange;
using interchange_test::expectSays;

constexpr double kDeg = std::numbers::pi / 180.0;

class ImportColumns : public ::testing::Test {
 protected:
  ImportColumns() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(STIFFSCOPE_TEST_OUTPUT) / "import_columns" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy_file(STIFFSCOPE_SOURCE_DIR "/samples/unloaded/robot.urdf", folder_ / "robot.urdf");
    write("points.csv", "target,pose,x_mm,y_mm,z_mm\nP10,A,1000,2000,300\nP10,B,1000,2100,300\n");
  }
  ~ImportColumns() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  ImportedDay imported(const std::string& elements) const {
    write("DAY.xml",
          "<day format=\"1\" name=\"Cell\" date=\"2031-03-04\">\n"
          "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\"/>\n"
          "<targets><target id=\"P10\"/><target id=\"P11\"/></targets>\n" +
              elements + "\n</day>\n");
    return importDay(folder_ / "DAY.xml");
  }

  std::string refusal(const std::string& elements) const {
    return interchange_test::refusalOf([&] { imported(elements); });
  }

  fs::path folder_;
};

const std::string kPoints = "<points role=\"loading\" file=\"points.csv\"/>";
const std::string kLog = "<log file=\"log.csv\"/>";
const std::string kJoints = "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg";

TEST_F(ImportColumns, WrenchAndTemperatureAreMeansWhileTheStateIsRead) {
  // The load is put on two seconds after the arm stands; the hall warms up.
  std::string log = "time_s," + kJoints + ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm,temperature_c\n";
  for (int i = 0; i <= 100; ++i)
    log +=
        fmt::format("{:.1f},0,0,0,0,20,0,0,0,{},0,0,0,{:.2f}\n", 0.1 * i, i < 20 ? 0 : -1500 - i % 2, 20.0 + 0.01 * i);
  for (int i = 1; i <= 20; ++i) log += fmt::format("{:.1f},{},0,0,0,20,0,0,0,0,0,0,0,21\n", 10.0 + 0.1 * i, i);
  write("log.csv", log);
  write("points.csv", "target,x_mm,y_mm,z_mm,time_s\nP10,1000,2000,300,5.0\nP11,1100,2000,300,6.0\n");
  const ImportedDay made = imported(kPoints + kLog + "<join by=\"clock\" offset_s=\"0\"/>");
  const campaign::State& state = made.campaign.states->rows.at(0);
  EXPECT_NEAR(state.wrench_in_cell[2], -1500.5, 0.1);
  EXPECT_NEAR(state.extras().temperature_c, 20.55, 1e-9);  // at 5.5 s
  write("points.csv", "target,x_mm,y_mm,z_mm,time_s\nP10,1000,2000,300,1.0\nP11,1100,2000,300,6.0\n");
  expectSays(refusal(kPoints + kLog + "<join by=\"clock\" offset_s=\"0\"/>"), {"log.csv:22", "fz", "pose 1"});
}

TEST_F(ImportColumns, ATemperatureMayBeBlank) {
  write("log.csv", "pose," + kJoints + ",temperature_c\nA,10,0,0,0,20,0,\nB,20,0,0,0,20,0,21.5\n");
  const ImportedDay made = imported(kPoints + kLog + "<join by=\"name\"/>");
  ASSERT_EQ(made.campaign.states->rows.size(), 2u);
  EXPECT_FALSE(made.campaign.states->rows[0].hasExtras());
  EXPECT_DOUBLE_EQ(made.campaign.states->rows[1].extras().temperature_c, 21.5);
  // A standstill has the mean of those that there are.
  std::string log = "time_s," + kJoints + ",temperature_c\n";
  for (int i = 0; i <= 20; ++i) log += fmt::format("{:.1f},0,0,0,0,20,0,{}\n", 0.1 * i, i % 2 == 0 ? "" : "20.5");
  write("log.csv", log);
  EXPECT_DOUBLE_EQ(imported(kLog).campaign.states->rows.at(0).extras().temperature_c, 20.5);
  // Rows of one pose say the same, or are refused.
  write("log.csv", "pose," + kJoints + ",temperature_c\nA,10,0,0,0,20,0,\nA,10,0,0,0,20,0,\nB,20,0,0,0,20,0,21.5\n");
  EXPECT_EQ(imported(kPoints + kLog + "<join by=\"name\"/>").skipped.size(), 1u);
  write("log.csv", "pose," + kJoints + ",temperature_c\nA,10,0,0,0,20,0,\nA,10,0,0,0,20,0,21\nB,20,0,0,0,20,0,21.5\n");
  expectSays(refusal(kPoints + kLog + "<join by=\"name\"/>"), {"log.csv:3", "same temperature"});
}

TEST_F(ImportColumns, AStepThatTheLogLacksIsRefused) {
  write("log.csv", "pose,step," + kJoints + ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\nA,0,10,0,0,0,20,0,0,0,0,0,0,0\n" +
                       "A,1,10.01,0,0,0,20,0,0,0,-500,0,0,0\n");
  write("points.csv", "pose,step,target,x_mm,y_mm,z_mm\nA,0,P10,1000,2000,300\nA,2,P10,1000,2000,299\n");
  expectSays(refusal(kPoints + kLog + "<join by=\"name\"/>"),
             {"points.csv:3", "step", "'2'", "pose A", "log.csv", "another step"});
}

TEST_F(ImportColumns, RowsThatSayTheSameAreListedAndOthersRefused) {
  const std::string header = "pose," + kJoints + ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\n";
  write("log.csv", header + "1,10,0,0,0,20,0,0,0,0,0,0,0\n1,10,0,0,0,20,0,0,0,0,0,0,0\n2,20,0,0,0,20,0,0,0,0,0,0,0\n");
  const ImportedDay made = imported(kLog);
  EXPECT_EQ(made.campaign.states->rows.size(), 2u);
  ASSERT_EQ(made.skipped.size(), 1u);
  EXPECT_EQ(made.skipped[0].row.line, 3u);
  EXPECT_EQ(made.skipped[0].row.reason, Skip::repeated_row);
  write("log.csv", header + "1,10,0,0,0,20,0,0,0,0,0,0,0\n1,10,0,0,0,20,0,0,0,-1500,0,0,0\n");
  expectSays(refusal(kLog), {"log.csv:3", "wrench", "line 2", "column step"});
}

TEST_F(ImportColumns, PosesOfLoadingAreByPoseAndStopsOfASweepByIndex) {
  write("points.csv",
        "index,pose,target,x_mm,y_mm,z_mm\n1,A,P10,1000,2000,300\n2,A,P11,1100,2000,300\n"
        "3,B,P10,1200,2000,300\n4,B,P11,1300,2000,300\n");
  const ImportedDay made = imported(kPoints);
  EXPECT_EQ(made.campaign.pose_ids, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(made.campaign.loading->rows[3].pose, 1);
  write("log.csv",
        "index,pose," + kJoints + "\n1,A,0,0,0,0,20,0\n2,A,0,0,0,0,25,0\n3,B,0,0,0,0,30,0\n4,B,0,0,0,0,35,0\n");
  const ImportedDay swept =
      imported("<points role=\"wrist_sweep\" file=\"points.csv\"/>" + kLog + "<join by=\"name\"/>");
  ASSERT_EQ(swept.campaign.wrist_sweep->rows.size(), 4u);
  EXPECT_EQ(swept.campaign.wrist_sweep->rows[1].index, "2");
  EXPECT_NEAR(swept.campaign.wrist_sweep->rows[1].q[4], 25.0 * kDeg, 1e-15);
}

TEST_F(ImportColumns, NestsThatNoNameFitsAreRefused) {
  write("n.csv", "nest,x_mm,y_mm,z_mm,time_s\nN1,1000,2000,300,1\nN2,1000,2000,300,100\n");
  expectSays(refusal(kPoints + "<points role=\"nests\" file=\"n.csv\" only=\"n1 n2\"/>"),
             {"DAY.xml:4: names: 'n.csv'", "nests", "2 names", "'N1'"});
}

TEST_F(ImportColumns, TheTargetOfAFileOfNestsIsTheirName) {
  write("n.csv", "x_mm,y_mm,z_mm,time_s\n1000,2000,300,1\n1000,2000,300,100\n");
  const ImportedDay made = imported(kPoints + "<points role=\"nests\" file=\"n.csv\" target=\"N1\"/>");
  EXPECT_EQ(made.campaign.nest_ids, std::vector<std::string>{"N1"});
  EXPECT_EQ(made.campaign.nests->rows.size(), 2u);
  EXPECT_TRUE(made.skipped.empty());
  // Whatever names the file has itself.
  write("n.csv", "name,x_mm,y_mm,z_mm,time_s\nMeas1,1000,2000,300,1\n");
  const ImportedDay named = imported(kPoints + "<points role=\"nests\" file=\"n.csv\" target=\"N1\"/>");
  EXPECT_EQ(named.campaign.nest_ids, std::vector<std::string>{"N1"});
}

TEST_F(ImportColumns, NestsAtOneTimeAreToldApartAndSaid) {
  const std::string elements = kPoints + "<points role=\"nests\" file=\"n.csv\"/>";
  write("n.csv", "nest,x_mm,y_mm,z_mm,time_s\nN1,1000,2000,300,1.00\nN1,1000,2000,300,1.04\n");
  const ImportedDay apart = imported(elements);
  EXPECT_EQ(apart.campaign.nests->rows[1].time_s, 1.04);
  EXPECT_TRUE(apart.warnings.empty());
  write("n.csv", "nest,x_mm,y_mm,z_mm,time_s\nN1,1000,2000,300,1.04\nN1,1000,2000,300,1.04\n");
  const ImportedDay one = imported(elements);
  ASSERT_EQ(one.warnings.size(), 1u);
  expectSays(one.warnings[0], {"n.csv:3", "time", "1 readings of nests", "0.005 s later"});
  // What is written can be read again.
  campaign::writeCampaign(one.campaign, one.urdf, folder_ / "out", {}, campaign::WrittenDigits::as_read);
  const campaign::CampaignReading again = campaign::readCampaign(folder_ / "out");
  EXPECT_NEAR(again.campaign.nests->rows[1].time_s, 1.045, 1e-9);
}

TEST_F(ImportColumns, AnglesOfTheMotorsSideAndCommandedOnesReachTheStates) {
  write("log.csv", "pose," + kJoints + ",m2_deg,m3_deg,c1_deg\nA,10,5,0,0,20,0,5.1,,10.2\nB,20,5,1,0,20,0,5.2,1.1,\n");
  const ImportedDay made = imported("<joint_reading joint=\"3\" plus=\"2\"/>" + kPoints + kLog + "<join by=\"name\"/>");
  EXPECT_TRUE(made.warnings.empty());
  const std::vector<campaign::State>& rows = made.campaign.states->rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[0].extras().motor_side[1], 5.1 * kDeg, 1e-12);
  EXPECT_TRUE(std::isnan(rows[0].extras().motor_side[2]));
  EXPECT_NEAR(rows[1].extras().motor_side[2], 6.3 * kDeg, 1e-12);  // 1.1 and the motor's 5.2, by the convention
  EXPECT_NEAR(rows[0].extras().commanded[0], 10.2 * kDeg, 1e-12);
  EXPECT_TRUE(std::isnan(rows[1].extras().commanded[0]));
  EXPECT_TRUE(std::isnan(rows[0].extras().commanded[1]));
  // Tables of sweeps have no such column.
  const ImportedDay swept =
      imported("<points role=\"wrist_sweep\" file=\"points.csv\"/>" + kLog + "<join by=\"name\"/>");
  ASSERT_EQ(swept.warnings.size(), 1u);
  expectSays(swept.warnings[0], {"log.csv", "not taken", "m1_deg", "c1_deg"});
}

TEST_F(ImportColumns, AWrenchBesideAFileOfLoadsIsSaidNotToBeTaken) {
  write("log.csv",
        "pose," + kJoints +
            ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\nA,10,5,0,0,20,0,0,0,-9,0,0,0\nB,20,5,1,0,20,0,0,0,-8,0,0,0\n");
  write("loads.csv", "pose,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\nA,0,0,-1,0,0,0\nB,0,0,-2,0,0,0\n");
  const std::string cell =
      "<load_cell parent=\"tool0\" xyz_mm=\"0 0 110\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" moment_sigma_nm=\"0.3\"/>";
  const ImportedDay made = imported(cell + kPoints + kLog + "<loads file=\"loads.csv\"/><join by=\"name\"/>");
  EXPECT_EQ(made.campaign.states->rows[1].wrench_in_cell[2], -2.0);
  ASSERT_EQ(made.warnings.size(), 1u);
  expectSays(made.warnings[0], {"log.csv", "not taken", "wrench"});
}

TEST_F(ImportColumns, AWrenchThatNobodyReadIsNotWrittenAsZero) {
  const std::string cell =
      "<load_cell parent=\"tool0\" xyz_mm=\"0 0 110\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" moment_sigma_nm=\"0.3\"/>";
  write("points.csv", "target,pose,step,x_mm,y_mm,z_mm\nP10,A,0,1000,2000,300\nP10,A,1,1000,2000,299\n");
  write("log.csv", "pose," + kJoints + "\nA,10,5,0,0,20,0\n");
  const auto columnsOf = [&](const ImportedDay& made) {
    campaign::writeCampaign(made.campaign, made.urdf, folder_ / "out", {}, campaign::WrittenDigits::as_read, "");
    std::string header;
    std::ifstream lines(folder_ / "out/states.csv");
    std::getline(lines, header);
    return header;
  };
  const ImportedDay made = imported(cell + kPoints + kLog + "<join by=\"name\"/>");
  ASSERT_EQ(made.warnings.size(), 1u);
  expectSays(made.warnings[0], {"DAY.xml: loads", "load steps have no wrench"});
  EXPECT_EQ(columnsOf(made), "pose,step," + kJoints);
  // A day without a load has no wrench either, which is nothing to warn of.
  write("points.csv", "target,pose,x_mm,y_mm,z_mm\nP10,A,1000,2000,300\n");
  const ImportedDay unloaded = imported(kPoints + kLog + "<join by=\"name\"/>");
  EXPECT_TRUE(unloaded.warnings.empty());
  EXPECT_EQ(columnsOf(unloaded), "pose,step," + kJoints);
  // Of two logs alone one has a wrench.
  write("loaded.csv", "pose," + kJoints + ",fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\nB,20,5,1,0,20,0,0,0,-8,0,0,0\n");
  const ImportedDay two = imported(cell + kLog + "<log file=\"loaded.csv\"/>");
  ASSERT_EQ(two.warnings.size(), 1u);
  expectSays(two.warnings[0], {"DAY.xml: log", "wrenches are not taken", "1 of 2 states"});
  EXPECT_EQ(columnsOf(two), "pose,step," + kJoints);
}

}  // namespace import_columns_test
}  // namespace stiffscope
