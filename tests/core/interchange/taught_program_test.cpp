#include "core/interchange/taught_program.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/interchange/refusal.h"

// Small programs in the grammar of each controller; none is a part of a published one.

namespace stiffscope {
namespace taught_program_test {

using namespace interchange;
using interchange_test::expectSays;

TaughtProgram parse(const std::string& text) { return parseTaughtProgram("work.txt", text, 6); }

std::string refusal(const std::string& text) {
  return interchange_test::refusalOf([&] { parse(text); });
}

/// The program with `degrees` in its target `place`.
std::string replaced(const std::string& text, std::size_t place, const std::array<double, 6>& degrees) {
  const TaughtProgram program = parse(text);
  std::vector<std::optional<JointVector>> figures(program.log.samples.size());
  figures[place] = JointVector(JointVector::Map(degrees.data(), 6) * std::numbers::pi / 180.0);
  return withFigures(program, figures);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A comment in the Western code page, CRLF, two groups and a target in space.
const std::string kFanuc =
    "/PROG  WORK\r\n/ATTR\r\nCOMMENT = \"gro\xdf, J1= 5 deg\";\r\n/MN\r\n   1:J P[1] 100% FINE    ;\r\n/POS\r\n"
    "P[1:\"\xe4\"]{\r\n   GP1:\r\n\tUF : 0, UT : 1,\r\n\tJ1=     6.206 deg,\tJ2=   -17.500 deg,\tJ3=   20.000 deg,\r\n"
    "\tJ4=    -.250 deg,\tJ5=   50.000 deg,\tJ6=   60.000 deg\r\n   GP2:\r\n\tUF : 0, UT : 1,\r\n\tJ1=  99.000 "
    "deg\r\n};\r\n"
    "P[2]{\r\n   GP1:\r\n\tUF : 0, UT : 1,\tCONFIG : 'N U T, 0, 0, 0',\r\n"
    "\tX = 1.0  mm,\tY = 2.0  mm,\tZ = 3.0  mm,\r\n\tW = 0.0 deg,\tP = 0.0 deg,\tR = 0.0 deg\r\n};\r\n/END\r\n";

TEST(TaughtProgram, OfFanucOnlyTheFiguresChange) {
  const TaughtProgram program = parse(kFanuc);
  ASSERT_EQ(program.log.samples.size(), 1u);
  ASSERT_EQ(program.log.skipped.size(), 1u);
  EXPECT_EQ(program.log.skipped[0].line, 16u);
  EXPECT_EQ(withFigures(program, {std::nullopt}), kFanuc);
  EXPECT_EQ(withFigures(program, {program.log.samples[0].figures}), kFanuc);  // -.250 stays as it is written
  std::string expected = with(kFanuc, "6.206", "6.219");
  expected = with(expected, "-17.500", "-17.514");
  expected = with(expected, "-.250", "0.000");
  EXPECT_EQ(replaced(kFanuc, 0, {6.2187, -17.5141, 20.0, -0.0001, 50.0, 60.0}), expected);
}

const std::string kKrl =
    "DEFDAT  WORK PUBLIC\n;DECL AXIS XP9={A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\n"
    "DECL E6AXIS XP1={A1 -5.0,A2 -90.0,A3 90.0,A4 1.5E1,A5 -2.5E-1,A6 0.0,E1 7.0,E2 0.0}\n"
    "DECL E6POS XP3={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0,S 2,T 35}\nENDDAT\n";

TEST(TaughtProgram, OfKrlData) {
  std::string expected = with(kKrl, "-5.0,", "-5.1234,");
  expected = with(expected, "1.5E1", "15.0100");
  EXPECT_EQ(replaced(kKrl, 0, {-5.12344, -90.0, 90.0, 15.01, -0.25, 0.0}), expected);
}

TEST(TaughtProgram, OfKrlInstructions) {
  const std::string source =
      "DEF WORK( )\nPTP {A1 10,A2 -90.00001,A3 90,A4 0,A5 30,A6 0}\nPTP HOME\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
      "SPTP {A1 20}\nPTP XP1 ; PTP {A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\nEND\n";
  const TaughtProgram program = parse(source);
  ASSERT_EQ(program.log.samples.size(), 1u);
  EXPECT_EQ(program.log.samples[0].name, "line 2");
  ASSERT_EQ(program.log.skipped.size(), 2u);
  EXPECT_EQ(program.log.skipped[0].line, 4u);
  EXPECT_EQ(program.log.skipped[1].line, 5u);  // axes 2 to 6 stay where they are, wherever that is
  EXPECT_EQ(decimalsOfTarget(program, 0), 5);
  EXPECT_EQ(replaced(source, 0, {10.5, -90.00001, 90, 0, 30, 0}), with(source, "A1 10,", "A1 10.50000,"));
}

TEST(TaughtProgram, OfRapid) {
  const std::string module =
      "MODULE Work\n! CONST jointtarget j9:=[[9,9,9,9,9,9],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  CONST jointtarget j1:=[[10,-20.5,30,40,50,60],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  PROC main()\n    MoveAbsJ j1, v100, fine, tool0;\n"
      "    MoveAbsJ [[1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0;\n"
      "    MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0;\n  ENDPROC\nENDMODULE\n";
  const TaughtProgram program = parse(module);
  ASSERT_EQ(program.log.samples.size(), 2u);
  EXPECT_EQ(program.log.samples[1].name, "line 6");
  ASSERT_EQ(program.log.skipped.size(), 1u);
  EXPECT_EQ(program.log.skipped[0].line, 7u);
  EXPECT_EQ(replaced(module, 0, {10, -20.5, 30, 40, 50, 60.1}), with(module, "50,60]", "50,60.1000]"));
  EXPECT_EQ(replaced(module, 1, {1, 2, 3, 4, 5.00004, 6}), module);  // less than a digit
}

TEST(TaughtProgram, RefusesWhatHasNoJointTargets) {
  std::string space = kFanuc;
  space.erase(space.find("P[1:"), space.find("P[2]") - space.find("P[1:"));
  expectSays(refusal(space), {"work.txt:7", "in space", "--path"});
  expectSays(refusal("Time [ms];X;Y;Z;W;P;R;J1;J2;J3;J4;J5;J6;\n0;1;2;3;4;5;6;1;2;3;4;5;6;\n"), {"expected a program"});
  expectSays(refusal(std::string("/\0P\0", 4)), {"UTF-16"});
  expectSays(refusal("DEFDAT X\nENDDAT\n"), {"there are none"});
}

}  // namespace taught_program_test
}  // namespace stiffscope
