#include "core/campaign/read_campaign.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace read_campaign_test {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRounding = 1e-12;  // conversions of units, of values up to a few metres

bool anyContains(const std::vector<std::string>& warnings, const std::string& text) {
  for (const std::string& warning : warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}

std::string shown(const std::vector<std::string>& warnings) {
  std::string all;
  for (const std::string& warning : warnings) all += warning + "\n";
  return all;
}

TEST(ReadCampaign, ReadsEverySectionInSi) {
  const SmallCampaign files;
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  const campaign::Campaign& c = reading.campaign;
  EXPECT_EQ(c.name, "small");
  EXPECT_EQ(c.date, "2026-01-02");
  EXPECT_EQ(c.texts.laboratory, "Force & Motion");
  EXPECT_EQ(c.texts.operator_name, "O");
  EXPECT_EQ(c.texts.conditions, "20 degC");
  EXPECT_EQ(c.double_encoder, campaign::DoubleEncoder::active);
  EXPECT_EQ(c.gravity_in_base, Eigen::Vector3d(0, 0, -9.80665));
  ASSERT_TRUE(c.tracker);
  EXPECT_NEAR(c.tracker->angle_per_m, 2.2e-6, kRounding);
  ASSERT_EQ(c.targets.size(), 2u);
  EXPECT_NEAR(c.targets[0].position_in_flange->z(), 0.3, kRounding);
  EXPECT_FALSE(c.targets[1].position_in_flange);
  ASSERT_TRUE(c.load_cell);
  const Eigen::Vector3d x_in_parent = c.load_cell->parent_from_cell.linear() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((x_in_parent - Eigen::Vector3d::UnitY()).norm(), 0.0, kRounding);
  EXPECT_NEAR(c.load_cell->parent_from_cell.translation().z(), 0.09, kRounding);
  EXPECT_NEAR(c.tool->com_in_flange.z(), 0.1, kRounding);
}

// Files from before say nothing of the joints. A joint without a second encoder is its motor's alone.
TEST(ReadCampaign, SaysWhichJointsHaveDoubleEncoders) {
  const SmallCampaign files;
  const campaign::Campaign before = campaign::readCampaign(files.folder()).campaign;
  EXPECT_TRUE(before.double_encoder_joints.empty());
  EXPECT_EQ(before.doubleEncoderOf(5), campaign::DoubleEncoder::active);
  files.alter("campaign.xml", "double_encoder=\"active\"",
              "double_encoder=\"active\" double_encoder_joints=\" 3 1\t2\"");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  EXPECT_EQ(reading.campaign.double_encoder_joints, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(reading.campaign.doubleEncoderOf(2), campaign::DoubleEncoder::active);
  EXPECT_EQ(reading.campaign.doubleEncoderOf(3), campaign::DoubleEncoder::inactive);
}

// A day of unloaded postures has less: no forces, no times, no repeats, no encoders' state.
TEST(ReadCampaign, AnUnloadedDayLacksForcesTimesAndRepeats) {
  const SmallCampaign files;
  files.alter("campaign.xml", " double_encoder=\"active\"", "");
  files.write("states.csv", "pose,step,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\nA,0,1,2,3,4,5,6\nB,0,6,5,4,3,2,1\n");
  files.write("loading.csv", "pose,step,target,x_mm,y_mm,z_mm\nA,0,P10,1,2,3\nA,0,P11,4,5,6\nB,0,P10,7,8,9\n");
  files.alter("campaign.xml", "<displacements", "<!-- <displacements");
  files.alter("campaign.xml", "<nests", "--> <nests");
  const campaign::Campaign c = campaign::readCampaign(files.folder()).campaign;
  EXPECT_EQ(c.double_encoder, campaign::DoubleEncoder::unspecified);
  ASSERT_EQ(c.states->rows.size(), 2u);
  EXPECT_TRUE(std::isnan(c.states->rows[0].time_s));
  EXPECT_TRUE(c.states->rows[0].wrench_in_cell.isZero(0.0));
  ASSERT_EQ(c.loading->rows.size(), 3u);
  EXPECT_TRUE(std::isnan(c.loading->rows[1].time_s));
  files.write("loading.csv", "pose,step,target,x_mm,y_mm,z_mm\nA,0,P10,1,2,3\nA,0,P10,4,5,6\nB,0,P10,7,8,9\n");
  try {
    campaign::readCampaign(files.folder());
    FAIL() << "the same reflector twice, and no repeat tells them apart";
  } catch (const io::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'A, 0, P10': expected a key that does not repeat; line 2"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReadCampaign, ReadsEveryTableInSi) {
  const SmallCampaign files;
  const campaign::Campaign c = campaign::readCampaign(files.folder() / "campaign.xml").campaign;
  ASSERT_EQ(c.circle_sweeps->rows.size(), 3u);
  EXPECT_EQ(c.circle_sweeps->rows[2].axis, 5);
  EXPECT_EQ(c.circle_sweeps->rows[1].target, 1);
  EXPECT_EQ(c.circle_sweeps->rows[1].line, 3u);
  EXPECT_TRUE(std::isnan(c.circle_sweeps->rows[0].time_s));
  EXPECT_NEAR(c.circle_sweeps->rows[2].q[5], 90 * kDegree, kRounding);
  EXPECT_NEAR(c.circle_sweeps->rows[0].point.y(), 2.4316095, kRounding);
  EXPECT_EQ(c.wrist_sweep->rows[0].time_s, 5.5);
  EXPECT_EQ(c.loading->rows[2].repeat, 2);
  EXPECT_EQ(c.loading->rows[2].step, 1);
  EXPECT_EQ(c.pose_ids, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(c.states->rows[2].pose, 1);
  EXPECT_EQ(c.states->rows[1].wrench_in_cell[0], -538.428);
  EXPECT_EQ(c.states->rows[1].wrench_in_cell[5], -11.28);
  EXPECT_EQ(c.displacements->frame, campaign::PointFrame::base_link);
  EXPECT_NEAR(c.displacements->rows[0].displacement.x(), -0.686e-3, kRounding);
  EXPECT_EQ(c.nest_ids, (std::vector<std::string>{"N1", "N2"}));
  EXPECT_EQ(c.nests->rows[1].time_s, 2.0);
}

TEST(ReadCampaign, HasAsManyJointAnglesAsTheRobot) {
  const SmallCampaign files(7);
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  const campaign::Campaign& c = reading.campaign;
  EXPECT_EQ(c.robot.joints(), 7);
  ASSERT_EQ(c.circle_sweeps->rows.size(), 3u);
  EXPECT_EQ(c.circle_sweeps->rows[2].axis, 6);
  ASSERT_EQ(c.circle_sweeps->rows[2].q.size(), 7);
  EXPECT_NEAR(c.circle_sweeps->rows[2].q[5], 90 * kDegree, kRounding);
  EXPECT_NEAR(c.circle_sweeps->rows[2].q[6], 2.25 * kDegree, kRounding);
  EXPECT_NEAR(c.circle_sweeps->rows[2].point.x(), 1.3844022, kRounding);
  EXPECT_NEAR(c.wrist_sweep->rows[0].q[6], 1.25 * kDegree, kRounding);
  ASSERT_EQ(c.states->rows.size(), 3u);
  EXPECT_NEAR(c.states->rows[1].q[6], 1.75 * kDegree, kRounding);
  EXPECT_EQ(c.states->rows[1].wrench_in_cell[0], -538.428);
  EXPECT_EQ(c.states->rows[0].extras().commanded.size(), 7);
  EXPECT_EQ(c.states->rows[0].extras().motor_side.size(), 7);
  EXPECT_TRUE(std::isnan(c.states->rows[0].extras().motor_side[6]));
}

TEST(ReadCampaign, RefusesWhatIsNotOfTheRobotsJoints) {
  struct Case {
    const char *file, *find, *replace, *message;
  };
  const Case cases[] = {
      {"states.csv", ",q7_deg", ",j7_deg", "states.csv:1: q7_deg: expected this column"},
      {"wrist_sweep.csv", ",q7_deg", ",j7_deg", "wrist_sweep.csv:1: q7_deg: expected this column"},
      {"circle_sweeps.csv", ",q7_deg", ",j7_deg", "circle_sweeps.csv:1: q7_deg: expected this column"},
      {"circle_sweeps.csv", "\n7,1,P10", "\n8,1,P10", "circle_sweeps.csv:4: axis: '8': expected an axis, 1 to 7"},
      {"states.csv", ",1.75,", ",one,", "states.csv:3: q7_deg: 'one': expected a number"},
      {"campaign.xml", "<tool ",
       "<known_stiffness joint=\"8\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"/><tool ",
       "campaign.xml:15: joint: '8': expected a joint's number, 1 to 7"},
      {"campaign.xml", "<tool ", "<joint_reading joint=\"7\" plus=\"8\"/><tool ",
       "campaign.xml:15: plus: '8': expected a joint's number, 1 to 7"},
      {"campaign.xml", "<tool ", "<joint_reading joint=\"9\" sign=\"-1\"/><tool ",
       "campaign.xml:15: joint: '9': expected a joint's number, 1 to 8"}};
  for (const Case& one : cases) {
    const SmallCampaign files(7);
    files.alter(one.file, one.find, one.replace);
    try {
      campaign::readCampaign(files.folder());
      ADD_FAILURE() << "read on instead of: " << one.message;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(one.message), std::string::npos) << error.what();
    }
  }
  // Of six joints the seventh's angle is a column that nobody wants.
  const SmallCampaign files;
  files.alter("wrist_sweep.csv", ",time_s\n", ",q7_deg\n");
  EXPECT_TRUE(anyContains(campaign::readCampaign(files.folder()).warnings, "q7_deg"));
}

TEST(ReadCampaign, StatesMayHaveSecondEncodersOfSomeJointsCommandsAndTemperatures) {
  const SmallCampaign files;
  const std::string before = files.read("states.csv");
  std::istringstream lines(before);
  std::string line, table;
  const char* more[] = {",m2_deg,m5_deg,c1_deg,temperature_c", ",1.5,,-2,23.5", ",,-0.25,,", ",1,2,3,"};
  for (std::size_t i = 0; i < 4 && std::getline(lines, line); ++i) table += line + more[i] + '\n';
  files.write("states.csv", table);
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  const std::vector<campaign::State>& rows = reading.campaign.states->rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].extras().motor_side[1], 1.5 * kDegree, kRounding);
  EXPECT_TRUE(std::isnan(rows[0].extras().motor_side[0]) && std::isnan(rows[0].extras().motor_side[4]) &&
              std::isnan(rows[1].extras().commanded[0]));
  EXPECT_NEAR(rows[1].extras().motor_side[4], -0.25 * kDegree, kRounding);
  EXPECT_NEAR(rows[0].extras().commanded[0], -2 * kDegree, kRounding);
  EXPECT_EQ(rows[0].extras().temperature_c, 23.5);
  EXPECT_TRUE(std::isnan(rows[2].extras().temperature_c));
}

TEST(ReadCampaign, ListsItsFilesWithTheHashOfTheirBytes) {
  const SmallCampaign files;
  const campaign::Campaign c = campaign::readCampaign(files.folder()).campaign;
  ASSERT_EQ(c.inputs.size(), 8u);
  EXPECT_EQ(c.inputs[0].name, "campaign.xml");
  EXPECT_EQ(c.inputs[1].name, "robot.urdf");
  for (const campaign::InputFile& input : c.inputs) EXPECT_EQ(input.sha256, io::sha256Hex(files.read(input.name)));
  // FIPS 180-4 example.
  EXPECT_EQ(io::sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ReadCampaign, TakesColumnsInAnyOrderWithCrlfMarkBlankLinesQuotesAndPlus) {
  const SmallCampaign files;
  files.write("nests.csv",
              "\xEF\xBB\xBFz_mm, nest ,y_mm,x_mm,time_s\r\n\r\n+3,\"N 1\",2,1e3,+0.5\r\n \r\n3,N2,2,-1,1\r\n");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  const auto& rows = reading.campaign.nests->rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR((rows[0].point - Eigen::Vector3d(1.0, 0.002, 0.003)).norm(), 0.0, kRounding);
  EXPECT_EQ(rows[1].line, 5u);
  EXPECT_EQ(reading.campaign.nest_ids[0], "N 1");
}

TEST(ReadCampaign, NeedsNoSectionButTheRobot) {
  const SmallCampaign files;
  files.write("campaign.xml",
              "<campaign format=\"1\" name=\"\" date=\"\"><robot urdf=\"robot.urdf\" base_link=\"base\" "
              "flange_link=\"flange\" double_encoder=\"unspecified\" gravity_m_s2=\"0 9.8 0\"/></campaign>");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  EXPECT_FALSE(reading.campaign.tracker || reading.campaign.loading || reading.campaign.tool);
  EXPECT_EQ(reading.campaign.gravity_in_base.y(), 9.8);
}

TEST(ReadCampaign, WarnsOfADateThatNoOrderOfDatesCanBeMadeOf) {
  const SmallCampaign files;
  const auto warnings = [&](const std::string& date) {
    files.write("campaign.xml", "<?xml version=\"1.0\"?>\n<campaign format=\"1\" name=\"\" date=\"" + date +
                                    "\"><robot urdf=\"robot.urdf\" base_link=\"base\" "
                                    "flange_link=\"flange\"/></campaign>");
    const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
    EXPECT_EQ(reading.campaign.date, date);  // kept as it is
    return reading.warnings;
  };
  for (const char* date : {"2026-11-27", "2024-02-29", "2026-11-27T09:30", "2026-11-27 09:30", "2026-11-27/2026-11-28"})
    EXPECT_TRUE(warnings(date).empty()) << date;
  for (const std::string date : {"27.11.26", "27.11.2026", "2026-11-27x", "2026-13-01", "2026-02-30", "2025-02-29",
                                 "2026-1-2", "26-11-27", "20261127", "2026-11-+7", "November"}) {
    const std::vector<std::string> said = warnings(date);
    ASSERT_EQ(said.size(), 1u) << date;
    EXPECT_NE(said[0].find("campaign.xml:2: date: '" + date + "': expected a date such as 2026-11-21"),
              std::string::npos)
        << said[0];
  }
}

TEST(ReadCampaign, LoadCellAxesReplaceItsRotation) {
  const SmallCampaign files;
  files.alter("campaign.xml", "rpy_deg=\"0 0 90\"", "rpy_deg=\"0 0 90\" axes=\"base\"");
  const campaign::Campaign c = campaign::readCampaign(files.folder()).campaign;
  EXPECT_EQ(c.load_cell->axes_link, "base");
  EXPECT_TRUE(c.load_cell->parent_from_cell.linear().isIdentity(0.0));
}

TEST(ReadCampaign, DeclaredUncertaintiesInTheirUnits) {
  const SmallCampaign files;
  const campaign::Campaign plain = campaign::readCampaign(files.folder()).campaign;
  EXPECT_EQ(plain.mass_sigma + plain.tracker->scale_sigma + plain.load_cell->angle_sigma + plain.load_cell->point_sigma,
            0.0);
  files.alter("campaign.xml", "<robot ", "<robot mass_sigma_percent=\"4\" ");
  files.alter("campaign.xml", "<tracker ", "<tracker scale_sigma_ppm=\"3\" ");
  files.alter("campaign.xml", "rpy_deg=\"0 0 90\"", "rpy_deg=\"0 0 90\" rpy_sigma_deg=\"90e-2\" xyz_sigma_mm=\"2\"");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  EXPECT_NEAR(reading.campaign.mass_sigma, 0.04, kRounding);
  EXPECT_NEAR(reading.campaign.tracker->scale_sigma, 3e-6, kRounding);
  EXPECT_NEAR(reading.campaign.load_cell->angle_sigma, 0.9 * 3.14159265358979 / 180.0, kRounding);
  EXPECT_NEAR(reading.campaign.load_cell->point_sigma, 0.002, kRounding);
}

TEST(ReadCampaign, StiffnessesKnownFromElsewhere) {
  const SmallCampaign files;
  const std::string first =
      "<known_stiffness joint=\"1\" nm_per_rad=\"5.6e6\" sd_nm_per_rad=\"2e5\" source=\"maker\"/>";
  files.alter("campaign.xml", "<tool mass_kg",
              first +
                  "<known_stiffness joint=\"6\" nm_per_rad=\"8e4\" "
                  "sd_nm_per_rad=\"1e3\" source=\"1 May\"/><tool mass_kg");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
  const auto& known = reading.campaign.known_stiffness;
  ASSERT_EQ(known.size(), 2u);
  EXPECT_EQ(known[0].joint, 0);
  EXPECT_EQ(known[0].stiffness, 5.6e6);
  EXPECT_EQ(known[0].sd, 2e5);
  EXPECT_EQ(known[1].joint, 5);
  EXPECT_EQ(known[1].source, "1 May");
}

TEST(ReadCampaign, RefusesStiffnessesThatCannotBeKnown) {
  const std::pair<const char*, const char*> cases[] = {
      {"joint=\"7\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"",
       "campaign.xml:15: joint: '7': expected a joint's number, 1 to 6"},
      {"joint=\"1.5\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"",
       "joint: '1.5': expected a joint's number"},
      {"joint=\"1\" nm_per_rad=\"-5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"",
       "nm_per_rad: '-5e6': expected Nm/rad, 1 to 1e10"},
      {"joint=\"1\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"0\" source=\"m\"",
       "sd_nm_per_rad: '0': expected a standard uncertainty above 0 and at most half of nm_per_rad"},
      {"joint=\"1\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"3e6\" source=\"m\"", "sd_nm_per_rad: '3e6'"},
      {"joint=\"1\" nm_per_rad=\"5e6\" source=\"m\"", "sd_nm_per_rad: expected this attribute"},
      {"joint=\"1\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\"", "source: expected this attribute"},
      {"joint=\"1\" nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"/><known_stiffness joint=\"1\" "
       "nm_per_rad=\"5e6\" sd_nm_per_rad=\"2e5\" source=\"m\"",
       "joint: '1': expected a joint that does not repeat"}};
  for (const auto& [attributes, message] : cases) {
    const SmallCampaign files;
    files.alter("campaign.xml", "<tool mass_kg", std::string("<known_stiffness ") + attributes + "/><tool mass_kg");
    try {
      campaign::readCampaign(files.folder());
      ADD_FAILURE() << "read on instead of: " << message;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(ReadCampaign, TurnsTheControllersFiguresIntoAngles) {
  const SmallCampaign plain, files;
  files.alter("campaign.xml", "<tool mass_kg",
              "<joint_reading joint=\"3\" sign=\"-1\" offset_deg=\"90\" plus=\"2\"/>"
              "<joint_reading joint=\"6\" offset_deg=\"-180\"/><tool mass_kg");
  files.alter("campaign.xml", "<robot ", "<robot controller_model=\"absolute_accuracy\" ");
  const campaign::CampaignReading raw = campaign::readCampaign(plain.folder());
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_EQ(reading.campaign.controller_model, campaign::ControllerModel::absolute_accuracy);
  const auto check = [](const auto& figures, const auto& angles) {
    ASSERT_FALSE(figures.rows.empty());
    for (std::size_t i = 0; i < figures.rows.size(); ++i) {
      JointVector q = figures.rows[i].q;
      q[2] = -q[2] + 90.0 * io::kDegree + q[1];
      q[5] -= 180.0 * io::kDegree;
      EXPECT_LT((angles.rows[i].q - q).norm(), 1e-11);  // the ninth decimal of a degree
    }
  };
  check(*raw.campaign.states, *reading.campaign.states);
  check(*raw.campaign.circle_sweeps, *reading.campaign.circle_sweeps);
  check(*raw.campaign.wrist_sweep, *reading.campaign.wrist_sweep);
}

TEST(ReadCampaign, RefusesFiguresThatGiveNoAngles) {
  const std::pair<const char*, const char*> cases[] = {
      {"joint=\"7\"", "joint: '7': expected a joint's number, 1 to 6"},
      {"joint=\"3\" sign=\"2\"", "sign: '2': expected 1 or -1"},
      {"joint=\"3\" offset_deg=\"9000\"", "offset_deg: '9000'"},
      {"joint=\"3\" plus=\"3\"", "plus: '3': expected another joint than this one"},
      {"joint=\"3\"/><joint_reading joint=\"3\"", "joint: '3': expected a joint that does not repeat"},
      {"joint=\"3\" plus=\"2\"/><joint_reading joint=\"2\" plus=\"3\"",
       "plus: '3': expected joints that are not added to each other in a circle"}};
  for (const auto& [attributes, message] : cases) {
    const SmallCampaign files;
    files.alter("campaign.xml", "<tool mass_kg", std::string("<joint_reading ") + attributes + "/><tool mass_kg");
    try {
      campaign::readCampaign(files.folder());
      ADD_FAILURE() << "read on instead of: " << message;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

struct Warned {
  const char *file, *find, *replace, *message;
};

TEST(ReadCampaign, WarnsInOneLineAndReadsOn) {
  const Warned cases[] = {
      {"nests.csv", "time_s,nest,x_mm,y_mm,z_mm\n0.0,N1,3349.2176,-241.6309,-1209.9495\n2.0,N2,",
       "time_s,nest,foo,bar,x_mm,y_mm,z_mm\n0,N1,7,7,1,2,3\n0,N2,7,,",
       "nests.csv:1: unknown columns ignored: 'foo', 'bar'"},
      {"wrist_sweep.csv", "time_s", "tme_s",
       "wrist_sweep.csv:1: unknown column ignored: 'tme_s' (did you mean 'time_s'?)"},
      {"nests.csv", "-1180.4804\n", "-1180.48", "nests.csv:3: the last line has no line end"},
      {"campaign.xml", "<tool mass_kg", "<tol/><tool mass_kg",
       "campaign.xml:15: tol: unknown element, ignored (did you mean 'tool'?)"},
      {"campaign.xml", "frame=\"base_link\"", "frme=\"x\"",
       "campaign.xml:20: frme: unknown attribute, ignored (did you mean 'frame'?)"},
      {"campaign.xml", "<target id=\"P11\"", "<target id=\"P11\" colour=\"red\"",
       "campaign.xml:12: colour: unknown attribute, ignored"},
      {"loading.csv", "A,0,1,P10,1078.0", "A,1,0,P10,1078.0",
       "loading.csv:2: pose: 'A': no unloaded step 0, so no displacement; poses without one: 1"},
      {"states.csv", "A,1,1170.3,7.93121", "A,1,1170.3,179.93121",
       "states.csv:3: q1_deg: '179.93': more than 5 deg outside the limits of joint_1 (-171.89 to 171.89 "
       "deg); rows "
       "like this: 1"},
      {"campaign.xml",
       "<load_cell parent=\"flange\" xyz_mm=\"0 0 90\" rpy_deg=\"0 0 90\" force_sigma_n=\"1\" "
       "moment_sigma_nm=\"0.3\"/>",
       "", "states.csv: no load_cell in campaign.xml says where these wrenches act"},
  };
  for (const Warned& test : cases) {
    const SmallCampaign files;
    files.alter(test.file, test.find, test.replace);
    const auto warnings = campaign::readCampaign(files.folder()).warnings;
    EXPECT_EQ(warnings.size(), 1u) << test.message << "\n" << shown(warnings);
    EXPECT_TRUE(anyContains(warnings, test.message)) << test.message << "\n" << shown(warnings);
  }
}

TEST(ReadCampaign, WarnsOfAnglesInRadians) {
  const SmallCampaign files;
  std::string rows = "index,target,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm\n";
  for (int i = 0; i < 10; ++i) rows += std::to_string(i) + ",P10,0,0,0,3.1,-1.2,0,1,2,3\n";
  files.write("wrist_sweep.csv", rows);
  EXPECT_TRUE(anyContains(campaign::readCampaign(files.folder()).warnings, "were they written in radians?"));
}

TEST(ReadCampaign, ReadsALargeTableInLinearTime) {
  const SmallCampaign files;
  std::string rows = "pose,step,repeat,target,time_s,x_mm,y_mm,z_mm\n";
  // About 40 MB; a cost that grows with the square would take hours.
  constexpr int kRows = 800000;
  for (int i = 0; i < kRows; ++i) rows += "A,0," + std::to_string(i) + ",P10,1078.0,2136.9015,156.1428,412.2275\n";
  files.write("loading.csv", rows);
  const std::vector<campaign::LoadingReading> read = campaign::readCampaign(files.folder()).campaign.loading->rows;
  ASSERT_EQ(read.size(), static_cast<std::size_t>(kRows));
  for (int i = 0; i < kRows; ++i) {
    const campaign::LoadingReading& row = read[static_cast<std::size_t>(i)];
    ASSERT_EQ(row.repeat, i);
    ASSERT_EQ(row.point.z(), read[0].point.z()) << row.line;
  }
}

// Keys in any order, and the one that repeats far from its first: found by the hash, where the order does not show it.
TEST(ReadCampaign, FindsARepeatedKeyFarApartInAnyOrder) {
  const SmallCampaign files;
  constexpr int kRows = 20000;
  for (const int repeated : {0, 9999, 19999}) {
    std::string rows = "pose,step,repeat,target,time_s,x_mm,y_mm,z_mm\n";
    const auto row = [&](int i) {
      rows += "A,0," + std::to_string(i * 7919 % kRows) + ",P10,1078.0,2136.9015,156.1428,412.2275\n";  // a prime: all
    };
    for (int i = 0; i < kRows; ++i) row(i);
    files.write("loading.csv", rows);
    EXPECT_EQ(campaign::readCampaign(files.folder()).campaign.loading->rows.size(), static_cast<std::size_t>(kRows));
    row(repeated);
    files.write("loading.csv", rows);
    try {
      campaign::readCampaign(files.folder());
      ADD_FAILURE() << "read a key twice";
    } catch (const io::InputError& error) {
      EXPECT_EQ(error.place().line, static_cast<std::size_t>(kRows + 2));
      EXPECT_EQ(error.expectation(),
                "expected a key that does not repeat; line " + std::to_string(repeated + 2) + " has it first");
    }
  }
}

TEST(ReadCampaign, ReadsThePracticeAndRealCampaigns) {
  const std::filesystem::path shared(STIFFSCOPE_SHARED_DIR);
  if (!std::filesystem::exists(shared / "practice")) GTEST_SKIP() << "no practice campaigns beside the checkout";
  const auto rowsIn = [](const std::filesystem::path& csv) {
    std::ifstream in(csv);
    std::size_t lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    return lines - 1;
  };
  int campaigns = 0;
  for (const char* group : {"practice", "real"}) {
    for (const auto& entry : std::filesystem::directory_iterator(shared / group)) {
      if (!entry.is_directory()) continue;
      const campaign::CampaignReading reading = campaign::readCampaign(entry.path());
      const campaign::Campaign& c = reading.campaign;
      const auto expectRows = [&](const auto& table) {
        if (!table) return;
        EXPECT_EQ(table->rows.size(), rowsIn(entry.path() / table->file));
      };
      expectRows(c.circle_sweeps);
      expectRows(c.wrist_sweep);
      expectRows(c.loading);
      expectRows(c.states);
      expectRows(c.displacements);
      expectRows(c.nests);
      EXPECT_EQ(c.robot.links.size(), 8u);
      EXPECT_TRUE(reading.warnings.empty()) << shown(reading.warnings);
      ++campaigns;
    }
  }
  EXPECT_GE(campaigns, 22);
}

}  // namespace read_campaign_test
}  // namespace stiffscope
