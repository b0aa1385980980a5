#include "core/interchange/robot_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/interchange/refusal.h"

// Small files in the grammar of each controller; none is a part of a published one.

namespace stiffscope {
namespace robot_log_test {

using namespace interchange;
using interchange_test::expectSays;

constexpr double kDeg = std::numbers::pi / 180.0;

RobotLog read(const std::string& text, const LogOptions& options = {}) {
  return parseRobotLog("robot.txt", text, options);
}

std::string refusal(const std::string& text, const LogOptions& options = {}) {
  return interchange_test::refusalOf([&] { read(text, options); });
}

void expectDegrees(const JointVector& found, const std::array<double, 6>& degrees) {
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(found[j], degrees[static_cast<std::size_t>(j)] * kDeg, 1e-14) << j;
}

const std::string kKarel =
    "Time [ms];X;Y;Z;W;P;R;J1;J2;J3;J4;J5;J6;\r\n"
    "1000;1;2;3;4;5;6;10.5;-20.25;30;40;50;-.5;\r\n"
    "1008;1;2;3;4;5;6;10.5;-20.25;30;40;50;+60.;\r\n";

TEST(KarelLog, MillisecondsAndDegrees) {
  const RobotLog log = read(kKarel);
  EXPECT_EQ(log.format, LogFormat::fanuc_karel);
  ASSERT_EQ(log.samples.size(), 2u);
  expectDegrees(log.samples[0].figures, {10.5, -20.25, 30, 40, 50, -0.5});
  EXPECT_DOUBLE_EQ(*log.samples[1].time_s, 1.008);
  EXPECT_EQ(log.samples[1].line, 3u);
}

TEST(KarelLog, PosesOfTheTool) {
  std::string text = "Time [ms];X;Y;Z;W;P;R;J1;J2;J3;J4;J5;J6;\n";
  text += "0;1080.5;-2;869.25;180;-45;.5;0;0;0;0;0;0;\n8;1081.5;-2;869.25;-180;-45;.5;5;0;0;0;0;0;\n";
  const RobotLog log = read(text);
  EXPECT_NEAR(log.samples[0].tool_pose.position.x(), 1.0805, 1e-15);
  EXPECT_NEAR(log.samples[0].tool_pose.rpy.y(), -45.0 * kDeg, 1e-15);
  EXPECT_TRUE(log.warnings.empty());
  // Columns that nobody filled are no pose.
  std::string still = text;
  still.replace(still.find("1081.5"), 6, "1080.5");
  const RobotLog empty = read(still);
  EXPECT_FALSE(empty.samples[0].tool_pose.hasPosition());
  ASSERT_EQ(empty.warnings.size(), 1u);
  expectSays(empty.warnings[0], {":2", "never changes", "not taken"});
}

TEST(LogColumns, PosesOfTheTool) {
  LogOptions options;
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg px_m py_m pz_m pw_rad pp_rad pr_rad";
  const RobotLog log = read("1 2 3 4 5 6 1.5 2.5 -0.5 0.1 0.2 0.3\n", options);
  EXPECT_EQ(log.samples[0].tool_pose.position, Eigen::Vector3d(1.5, 2.5, -0.5));
  EXPECT_EQ(log.samples[0].tool_pose.rpy, Eigen::Vector3d(0.1, 0.2, 0.3));
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg pw_deg pp_deg pr_deg";
  expectSays(refusal("1 2 3 4 5 6 1 2 3\n", options), {"px, py and pz"});
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg px_m py_m pz_m";
  expectSays(refusal("1 2 3 4 5 6 1e3 2 3\n", options), {":1", "200 m"});
}

TEST(KarelLog, RefusesTornRowsWrongNumbersAndTimesThatRunBack) {
  expectSays(refusal(kKarel + "1016;1;2;3;4;5"), {":4", "6 cells", "ends in the middle"});
  expectSays(refusal(kKarel + "1016;1;2;3;4;5;6;10,5;-20;30;40;50;60;\r\n"), {":4", "joint 1", "'10,5'"});
  expectSays(refusal(kKarel + "900;1;2;3;4;5;6;10.5;-20;30;40;50;60;\r\n"), {":4", "time", "two logs"});
  expectSays(refusal(kKarel + "1016;1;2;3;4;5;6;1050;-20;30;40;50;60;\r\n"), {":4", "joint 1", "720"});
  LogOptions rate;
  rate.rate_hz = 125.0;
  expectSays(refusal(kKarel, rate), {"rate_hz", "times of its own"});
  LogOptions wanted;
  wanted.format = LogFormat::rapid;
  expectSays(refusal(kKarel, wanted), {"format", "rapid", "expected fanuc_karel"});
}

TEST(UrLog, RadiansByNameAndRate) {
  LogOptions rate;
  rate.rate_hz = 125.0;
  const RobotLog log =
      read("Joint0 Joint1 Joint2 Joint3 Joint4 Joint5\n0.1 -0.2 0.3 0.4 0.5 0.6\n0.1 -0.2 0.3 0.4 0.5 0.7\n", rate);
  EXPECT_EQ(log.format, LogFormat::ur);
  EXPECT_DOUBLE_EQ(log.samples[1].figures[5], 0.7);
  EXPECT_DOUBLE_EQ(*log.samples[1].time_s, 0.008);
  const RobotLog named =
      read("timestamp,actual_q_5,actual_q_4,actual_q_3,actual_q_2,actual_q_1,actual_q_0\n12.5,6,5,4,3,2,1\n");
  EXPECT_DOUBLE_EQ(named.samples[0].figures[0], 1.0);
  EXPECT_DOUBLE_EQ(*named.samples[0].time_s, 12.5);
}

TEST(UrLog, DegreesReadAsRadiansAreSaidToBeThat) {
  const std::string header = "actual_q_0,actual_q_1,actual_q_2,actual_q_3,actual_q_4,actual_q_5\n";
  expectSays(refusal(header + "13.6,23.9,85.4,57.1,33.6,102.7\n"),
             {":2", "joint 1", "779.223 deg", "degrees read as radians"});
  expectSays(refusal("q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad\n0,0,90,0,0,0\n"),
             {":2", "joint 3", "degrees read as radians"});
  // Of figures in degrees none is too large for being in radians.
  EXPECT_EQ(refusal("q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n0,0,900,0,0,0\n").find("radians"), std::string::npos);
}

TEST(KarelLog, ColumnsThatAreNotReadAreNamed) {
  const std::string axis = "Time [ms];J1;J2;J3;J4;J5;J6;E1;\n0;1;2;3;4;5;6;100;\n8;1;2;3;4;5;6;200;\n";
  const RobotLog log = read(axis);
  ASSERT_EQ(log.warnings.size(), 1u);
  expectSays(log.warnings[0], {"robot.txt:1", "not read: E1"});
  // Of a controller that writes everything the first are named.
  std::string header = "timestamp,q0,q1,q2,q3,q4,q5", row = "0,1,2,3,4,5,6";
  for (int k = 0; k < 30; ++k) {
    header += ",actual_current_" + std::to_string(k);
    row += ",1";
  }
  const RobotLog ur = read(header + '\n' + row + '\n');
  ASSERT_EQ(ur.warnings.size(), 1u);
  expectSays(ur.warnings[0], {"actual_current_0, actual_current_1", "actual_current_7 and 22 more"});
}

TEST(LogColumns, AnglesOfTheMotorsSideAndCommandedOnes) {
  LogOptions options;
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg m2_rad c1_deg c6_deg";
  options.table.separator = ";";
  const RobotLog log = read("1;2;3;4;5;6;0.25;1.5;6.5\n1;2;3;4;5;6;;1.5;\n", options);
  EXPECT_TRUE(log.warnings.empty());
  ASSERT_EQ(log.motor_side.size(), 2u);
  ASSERT_EQ(log.commanded.size(), 2u);
  EXPECT_DOUBLE_EQ(log.motor_side[0][1], 0.25);
  EXPECT_TRUE(std::isnan(log.motor_side[0][0]));
  EXPECT_TRUE(std::isnan(log.motor_side[1][1]));
  EXPECT_NEAR(log.commanded[0][5], 6.5 * kDeg, 1e-15);
  EXPECT_NEAR(log.commanded[1][0], 1.5 * kDeg, 1e-15);
  EXPECT_TRUE(std::isnan(log.commanded[1][5]));
  // No table of states could hold a motor's own turns.
  expectSays(refusal("1;2;3;4;5;6;40;1.5;6.5\n", options), {":1", "m2", "720", "gear"});
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg m1_deg m7_deg -";
  const RobotLog seven = read("1;2;3;4;5;6;1;7;8\n", options);
  EXPECT_TRUE(seven.commanded.empty());
  ASSERT_EQ(seven.warnings.size(), 1u);
  expectSays(seven.warnings[0], {"m7", "six joints"});
}

TEST(LogColumns, AWrench) {
  LogOptions options;
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg fx_n fy_kn fz_n mx_nm my_nm mz_nm";
  const RobotLog log = read("1 2 3 4 5 6 10 0.02 30 4 5 6\n", options);
  const Vector6d wrench = (Vector6d() << 10, 20, 30, 4, 5, 6).finished();
  EXPECT_TRUE(log.samples[0].wrench.isApprox(wrench, 1e-15));
  expectSays(refusal("1 2 3 4 5 6 10 _ 30 4 5 6\n", options), {":1", "fy_kn", "'_'"});
}

TEST(LogColumns, NamedByTheUser) {
  LogOptions options;
  options.table.columns = "pose step q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg temperature_c";
  options.table.decimal_comma = true;
  const RobotLog log = read("A;0;1,5;2;3;4;5;6;21,5\nA;1;1,5;2;3;4;5;6;21,5\n", options);
  EXPECT_EQ(log.format, LogFormat::columns);
  expectDegrees(log.samples[0].figures, {1.5, 2, 3, 4, 5, 6});
  EXPECT_EQ(log.samples[1].name, "A");
  EXPECT_EQ(log.samples[1].step, 1);
  EXPECT_DOUBLE_EQ(log.samples[1].temperature_c, 21.5);
  EXPECT_FALSE(log.samples[1].time_s);
  EXPECT_FALSE(log.samples[1].wrench.allFinite());
  options.table.columns = "pose q1_deg q2_deg q3_deg q4_deg q5_deg -";
  expectSays(refusal("A;1;2;3;4;5;6\n", options), {"q1 to q6"});
  options.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg fx_n fy_n";
  expectSays(refusal("1;2;3;4;5;6;7;8\n", options), {"fz", "all or none"});
}

const std::string kProgram =
    "/PROG  WORK\n/ATTR\nCOMMENT = \"P[9]{\";\n/MN\n   1:J P[1] 100% FINE    ;\n/POS\n"
    "P[1]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1=     6.206 deg,\tJ2=   -17.5 deg,\tJ3=   20.000 deg,\n"
    "\tJ4=    -.250 deg,\tJ5=   50.000 deg,\tJ6=   60.000 deg\n};\n"
    "P[2:\"home\"]{\n   GP1:\n\tUF : 0, UT : 1,\tCONFIG : 'N U T, 0, 0, 0',\n"
    "\tX = 1.0  mm,\tY = 2.0  mm,\tZ = 3.0  mm,\n\tW = 0.0 deg,\tP = 0.0 deg,\tR = 0.0 deg\n};\n"
    "P[3:\"home\"]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 1 deg,J2= 2 deg,J3= 3 deg,J4= 4 deg,J5= 5 deg,J6= 6 deg\n"
    "   GP2:\n\tUF : 0, UT : 1,\n\tJ1= 99 deg\n};\n/END\n";

TEST(FanucProgram, JointTargetsOfTheFirstGroup) {
  const RobotLog log = read(kProgram);
  EXPECT_EQ(log.format, LogFormat::fanuc_tp);
  ASSERT_EQ(log.samples.size(), 2u);
  EXPECT_EQ(log.samples[0].name, "P[1]");
  EXPECT_EQ(log.samples[0].line, 7u);
  expectDegrees(log.samples[0].figures, {6.206, -17.5, 20, -0.25, 50, 60});
  EXPECT_EQ(log.samples[1].name, "P[3]");
  expectDegrees(log.samples[1].figures, {1, 2, 3, 4, 5, 6});
  ASSERT_EQ(log.skipped.size(), 1u);
  EXPECT_EQ(log.skipped[0].reason, Skip::joints_not_given);
  EXPECT_EQ(log.skipped[0].line, 13u);
}

TEST(FanucProgram, RefusesTornAndRepeatedTargets) {
  expectSays(refusal(kProgram.substr(0, kProgram.find("J4="))), {"expected '}'", "ends here"});
  expectSays(refusal(kProgram.substr(0, kProgram.find("/END"))), {"expected /END"});
  std::string twice = kProgram;
  twice.replace(twice.find("P[3:"), 4, "P[1:");
  expectSays(refusal(twice), {":19", "P[1]", "line 7 has it first"});
  std::string five = kProgram;
  five.replace(five.find("J6="), 3, "JX=");
  expectSays(refusal(five), {":7", "P[1]", "all six joints"});
  std::string radians = kProgram;
  radians.replace(radians.find("6.206 deg"), 9, "6.206 rad");
  expectSays(refusal(radians), {":10", "expected deg"});
}

const std::string kKrl =
    "&ACCESS RVP\nDEFDAT  WORK PUBLIC\n;DECL AXIS XP9={A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\n"
    "DECL E6AXIS XP1={A1 -5.0,A2 -90.0,A3 90.0,A4 1.5E1,A5 -2.5E-1,A6 0.0,E1 0.0,E2 0.0}\n"
    "DECL GLOBAL AXIS XP2 = {AXIS: A1 1, A2 2, A3 3, A4 4, A5 5, A6 6}\n"
    "DECL E6POS XP3={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0,S 2,T 35}\nDECL AXIS XP4\nENDDAT\n";

TEST(KukaData, AxesOfDeclarations) {
  const RobotLog log = read(kKrl);
  EXPECT_EQ(log.format, LogFormat::kuka_krl);
  ASSERT_EQ(log.samples.size(), 2u);
  EXPECT_EQ(log.samples[0].name, "XP1");
  EXPECT_EQ(log.samples[0].line, 4u);
  expectDegrees(log.samples[0].figures, {-5, -90, 90, 15, -0.25, 0});
  EXPECT_EQ(log.samples[1].line, 5u);
  expectDegrees(log.samples[1].figures, {1, 2, 3, 4, 5, 6});
  ASSERT_EQ(log.skipped.size(), 1u);
  EXPECT_EQ(log.skipped[0].line, 6u);
}

TEST(KukaData, RefusesWhatIsNotAnAxis) {
  expectSays(refusal("DEFDAT X\nDECL AXIS XP1={A1 1,A2 2,B3 3}\n"), {":2", "'B3'", "A1 to A6"});
  expectSays(refusal("DEFDAT X\nDECL AXIS XP1={A1 1,A2 2}\n"), {":2", "XP1", "A1 to A6"});
  expectSays(refusal("DEFDAT X\nDECL AXIS XP1={A1 1,A2 zwei}\n"), {":2", "'zwei'", "number"});
  expectSays(refusal("DEFDAT X\nDECL AXIS XP1={A1 1,A2"), {":2", "ends here"});
  expectSays(refusal("DEFDAT X\nENDDAT\n"), {"there are none"});
  expectSays(refusal(kKrl + "DECL AXIS xp1={A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\n"), {":9", "xp1", "line 4"});
}

TEST(Rapid, JointtargetsOfModulesAndRokae) {
  const RobotLog log = read(
      "MODULE Work\n! CONST jointtarget j9:=[[9,9,9,9,9,9],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  CONST jointtarget j1:=[[10,-20.5,30,40,50,60],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  CONST robtarget p1:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  jointtarget j2 := [ [1, 2, 3,\n 4, 5, 6], [0,0,0,0,0,0] ];\n  PROC move(jointtarget at)\n  "
      "ENDPROC\nENDMODULE\n");
  EXPECT_EQ(log.format, LogFormat::rapid);
  ASSERT_EQ(log.samples.size(), 2u);
  EXPECT_EQ(log.samples[0].name, "j1");
  EXPECT_EQ(log.samples[0].line, 3u);
  expectDegrees(log.samples[0].figures, {10, -20.5, 30, 40, 50, 60});
  expectDegrees(log.samples[1].figures, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(log.samples[1].line, 5u);
  ASSERT_EQ(log.skipped.size(), 1u);
  EXPECT_EQ(log.skipped[0].line, 4u);
  const RobotLog rokae = read("jointtarget j1 = j:{1,2,3,4,5,6}{EJ 0,0,0,0,0,0}\n");
  expectDegrees(rokae.samples[0].figures, {1, 2, 3, 4, 5, 6});
  expectSays(refusal("jointtarget j1:=[[1,2,3,4,5],[0]];\n"), {":1", "expected ','"});
  expectSays(refusal("jointtarget j1:=[1,2,3,4,5,6];\n"), {":1", "expected '['"});
}

LogOptions ofSevenJoints() {
  LogOptions options;
  options.joints = 7;
  return options;
}

TEST(RobotLog, HasAsManyJointsAsTheMachine) {
  const std::string table =
      "Time [ms];X;Y;Z;W;P;R;J1;J2;J3;J4;J5;J6;J7;\n1000;1;2;3;4;5;6;10.5;-20.25;30;40;50;-.5;7.5;\n";
  const RobotLog seven = read(table, ofSevenJoints());
  ASSERT_EQ(seven.samples.size(), 1u);
  ASSERT_EQ(seven.samples[0].figures.size(), 7);
  EXPECT_NEAR(seven.samples[0].figures[6], 7.5 * kDeg, 1e-15);
  EXPECT_TRUE(seven.warnings.empty());
  const RobotLog six = read(table);  // of a machine that has not the seventh
  ASSERT_EQ(six.samples[0].figures.size(), 6);
  expectDegrees(six.samples[0].figures, {10.5, -20.25, 30, 40, 50, -0.5});
  ASSERT_EQ(six.warnings.size(), 1u);
  expectSays(six.warnings[0], {":1", "j7", "six joints"});
  expectSays(refusal(kKarel, ofSevenJoints()), {":1", "J7"});

  LogOptions columns = ofSevenJoints();
  columns.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg q7_deg";
  EXPECT_NEAR(read("1 2 3 4 5 6 7\n", columns).samples[0].figures[6], 7 * kDeg, 1e-15);
  columns.table.columns = "q1_deg q2_deg q3_deg q4_deg q5_deg q6_deg";
  expectSays(refusal("1 2 3 4 5 6\n", columns), {"q1 to q7"});
}

TEST(RobotLog, ProgramsOfSixAxesAreNotThoseOfOthers) {
  expectSays(refusal(kProgram, ofSevenJoints()), {":7", "P[1]", "all seven joints"});
  std::string more = kProgram;
  more.replace(more.find("J6=   60.000 deg"), 16, "J6=   60.000 deg,\tJ7= 70 deg");
  expectSays(refusal(more), {":7", "P[1]", "all six joints", "more joints than the machine"});
  expectSays(refusal(kKrl, ofSevenJoints()), {":4", "columns", "machine of six"});
  expectSays(refusal("jointtarget j1:=[[1,2,3,4,5,6],[0,0,0,0,0,0]];\n", ofSevenJoints()), {":1", "machine of six"});
}

TEST(RobotLog, RefusesWhatIsNone) {
  expectSays(refusal("hello\n"), {":1", "'hello'", "fanuc_karel", "columns"});
  expectSays(refusal("\x81"), {"0x81"});
}

TEST(RobotLog, AProgramOfAHundredThousandTargetsIsRead) {
  std::string text = "DEFDAT X\n";
  for (int i = 0; i < 100'000; ++i) text += "DECL AXIS X" + std::to_string(i) + "={A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\n";
  const RobotLog log = read(text);
  ASSERT_EQ(log.samples.size(), 100'000u);
  EXPECT_EQ(log.samples.back().line, 100'001u);
}

}  // namespace robot_log_test
}  // namespace stiffscope
