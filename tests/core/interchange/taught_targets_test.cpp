#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/interchange/robot_log.h"
#include "core/interchange/taught_program.h"
#include "reports/text/text.h"
#include "tests/core/interchange/refusal.h"

// Where targets stand in programs. A target that is passed over without a word leaves a program that is compensated by
// halves. Small programs in the grammar of each controller; none is a part of a published one.

namespace stiffscope {
namespace taught_targets_test {

using namespace interchange;
using interchange_test::expectSays;

/// As `compensate --program` reads it.
TaughtProgram program(const std::string& text) { return parseTaughtProgram("work.txt", text, 6); }

/// As the importer reads it.
RobotLog log(const std::string& text) { return parseRobotLog("work.txt", text, {}); }

std::string refusal(const std::string& text) {
  return interchange_test::refusalOf([&] { program(text); });
}

std::vector<std::string> namesOf(const RobotLog& of) {
  std::vector<std::string> names;
  for (const JointSample& sample : of.samples) names.push_back(sample.name);
  return names;
}

std::vector<std::size_t> skippedLines(const RobotLog& of) {
  std::vector<std::size_t> lines;
  for (const SkippedRow& row : of.skipped) lines.push_back(row.line);
  return lines;
}

using Names = std::vector<std::string>;
using Lines = std::vector<std::size_t>;

/// The program with 1 deg more on joint 1 of every target.
std::string turned(const std::string& text) {
  const TaughtProgram read = program(text);
  std::vector<std::optional<JointVector>> figures;
  for (const JointSample& sample : read.log.samples) {
    figures.emplace_back(sample.figures);
    (*figures.back())[0] += std::numbers::pi / 180.0;
  }
  return withFigures(read, figures);
}

std::string with(std::string text, const std::vector<std::array<std::string, 2>>& edits) {
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

const std::string kModule =
    "MODULE M\n"
    "CONST jointtarget j1:=[[10,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "CONST jointtarget ja{2}:=[[[11,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\n"
    "  [[12,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];\n"
    "VAR num m{2,6}:=[[1,2,3,4,5,6],[7,8,9,10,11,12]];\n"
    "VAR string s:=\"[[13,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\";\n"
    "VAR jointtarget jt;\n"
    "PROC main()\n"
    "  jt:=[[14,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "  MoveAbsJ [[30,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v100,fine,tool0;\n"
    "  MoveAbsJ \\Conc, [[31,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v100,fine,tool0;\n"
    "  jt:=[[15,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "  MoveAbsJ ja{1},v100,fine,tool0;\n"
    "ENDPROC\nENDMODULE\n";

TEST(RapidTargets, OfArraysAssignmentsAndInstructionsAreReplaced) {
  const TaughtProgram read = program(kModule);
  ASSERT_EQ(namesOf(read.log), (Names{"j1", "ja{1}", "ja{2}", "jt", "line 10", "line 11", "line 12"}));
  EXPECT_EQ(read.log.samples[2].line, 4u);
  EXPECT_TRUE(read.log.skipped.empty());
  EXPECT_EQ(turned(kModule), with(kModule, {{"[[10,", "[[11.0000,"},
                                            {"[[11,", "[[12.0000,"},
                                            {"[[12,", "[[13.0000,"},
                                            {"[[14,", "[[15.0000,"},
                                            {"[[30,", "[[31.0000,"},
                                            {"[[31,", "[[32.0000,"},
                                            {"[[15,", "[[16.0000,"}}));
}

TEST(RapidTargets, OfArraysOfTwoDimensions) {
  const std::string e = ",[9E9,9E9,9E9,9E9,9E9,9E9]]";
  const RobotLog read = log("MODULE M\nCONST jointtarget jb{2,2}:=[[[[1,0,0,0,0,0]" + e + ",[[2,0,0,0,0,0]" + e +
                            "],[[[3,0,0,0,0,0]" + e + ",[[4,0,0,0,0,0]" + e + "]];\nENDMODULE\n");
  EXPECT_EQ(namesOf(read), (Names{"jb{1,1}", "jb{1,2}", "jb{2,1}", "jb{2,2}"}));
  expectSays(refusal("MODULE M\nCONST jointtarget jb{1,1,1,1}:=" + std::string(100'000, '[') + "\n"),
             {"work.txt:2", "three dimensions"});
  expectSays(refusal("MODULE M\nCONST jointtarget j1:=[[[1,2,3,4,5,6],[1,2,3,4,5,6]]];\n"), {"work.txt:2", "number"});
}

TEST(RapidTargets, WhatIsNotReplacedIsListed) {
  const TaughtProgram read = program(
      "MODULE M\n"
      "CONST jointtarget j1:=[[10,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "VAR jointtarget j2:=[[nA,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "VAR jointtarget j3:=[rob,ext];\n"
      "VAR jointtarget ja{2}:=[j1,\n"
      "  [[11,5,0,0,20,0],ext]];\n"
      "PROC main()\n"
      "  MoveAbsJ [[10+nB,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
      "  MyMove [[33,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100;\n"
      "  MyMove [[33,5,0,0,20,0],ext],v100;\n"
      "  elsewhere:=[[34,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "  j2.robax.rax_1:=j1.robax.rax_1+45;\n"
      "  MoveL \\Conc, [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
      "ENDPROC\nENDMODULE\n");
  EXPECT_EQ(namesOf(read.log), (Names{"j1", "ja{2}"}));
  EXPECT_EQ(skippedLines(read.log), (Lines{3, 4, 5, 8, 9, 10, 11, 12, 13}));
}

TEST(RapidTargets, TheImporterHasArraysAndListsInstructions) {
  const RobotLog read = log(with(kModule, {{"  jt:=[[15,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n", ""}}));
  EXPECT_EQ(namesOf(read), (Names{"j1", "ja{1}", "ja{2}", "jt"}));
  ASSERT_EQ(skippedLines(read), (Lines{10, 11}));
  EXPECT_EQ(read.skipped[0].reason, Skip::in_instruction);
  // Which of its two values a name stands for nobody knows.
  expectSays(interchange_test::refusalOf([] { log(kModule); }), {":12", "'jt'", "line 9 has it first"});
}

TEST(RapidTargets, ADeclarationWithoutNumbersIsPassedOver) {
  const std::string module =
      "MODULE M\nCONST jointtarget j1:=[[10,5,0,0,20,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR jointtarget jNow;\n"
      "PROC main()\n  VAR jointtarget jTmp:=j1;\n  VAR jointtarget jTool:=CJointT();\n  VAR jointtarget k:=j;\n"
      "  jNow:=CJointT();\nENDPROC\nENDMODULE\n";
  for (const RobotLog& read : {program(module).log, log(module)}) {
    EXPECT_EQ(namesOf(read), (Names{"j1"}));
    EXPECT_TRUE(read.skipped.empty());
  }
}

const std::string kSource =
    "DEF PROG()\nDECL E6AXIS XP1\nDECL E6AXIS XARR[3]\nDECL GAINS G\n"
    "G={A1 1.0,A2 1.0,A3 1.0,A4 1.0,A5 1.0,A6 1.0}\n"
    "XP1={A1 10.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0,E1 0.0}\n"
    "XARR[1]={A1 11.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0,E1 0.0}\n"
    "PTP XP1\n"
    "PTP {E6AXIS: A1 13.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0}\n"
    "PTP {A1 14.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0} C_PTP\n"
    "XP1 = {A1 15.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0} ; XP1={A1 9}\nEND\n";

TEST(KrlTargets, OfAssignmentsAndInstructionsAreReplaced) {
  const TaughtProgram read = program(kSource);
  EXPECT_EQ(namesOf(read.log), (Names{"XP1", "XARR[1]", "line 9", "line 10", "line 11"}));
  EXPECT_TRUE(read.log.skipped.empty());
  EXPECT_EQ(turned(kSource), with(kSource, {{"A1 10.0", "A1 11.0000"},
                                            {"A1 11.0,", "A1 12.0000,"},
                                            {"A1 13.0,", "A1 14.0000,"},
                                            {"A1 14.0,", "A1 15.0000,"},
                                            {"A1 15.0,", "A1 16.0000,"}}));
}

TEST(KrlTargets, WhatIsNotReplacedIsListed) {
  const TaughtProgram read = program(
      "DEF PROG()\nDECL AXIS XP1\nXP1={A1 10,A2 5,A3 0,A4 0,A5 20,A6 0}\nXP1={A1 5}\nXP1.A1=XP1.A1+45\n"
      "IF XP1.A1==5 THEN\nENDIF\nPTP_REL {A1 1,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
      "XE[1]={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 35}\n$BASE={X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
      "P.AT={E6AXIS: A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\nEND\n");
  EXPECT_EQ(namesOf(read.log), (Names{"XP1"}));
  EXPECT_EQ(skippedLines(read.log), (Lines{4, 5, 8, 9, 11}));
}

TEST(KrlTargets, TheImporterHasElementsOfArraysAndListsInstructions) {
  const RobotLog data =
      log("DEFDAT PROG\nDECL E6AXIS XP1={A1 10.0,A2 -90.0,A3 90.0,A4 0.0,A5 20.0,A6 0.0,E1 0.0}\nDECL E6AXIS XARR[3]\n"
          "XARR[1]={A1 11.0,A2 -90.0,A3 90.0,A4 0.0,A5 20.0,A6 0.0,E1 0.0}\n"
          "XARR[2]={A1 12.0,A2 -90.0,A3 90.0,A4 0.0,A5 20.0,A6 0.0,E1 0.0}\n"
          "DECL AXIS XP2\nDECL AXIS XP3={A1 20.0,A2 -90.0,A3 90.0,A4 0.0,A5 20.0,A6 0.0}\n"
          "PTP {A1 14.0,A2 5.0,A3 0.0,A4 0.0,A5 20.0,A6 0.0}\nENDDAT\n");
  EXPECT_EQ(namesOf(data), (Names{"XP1", "XARR[1]", "XARR[2]", "XP3"}));
  ASSERT_EQ(skippedLines(data), (Lines{8}));
  EXPECT_EQ(data.skipped[0].reason, Skip::in_instruction);
}

TEST(ProgramText, CountsTheTargetsThatWereLeft) {
  const TaughtProgram read = program(
      "DEF PROG()\nDECL AXIS XP1\nXP1={A1 10,A2 5,A3 0,A4 0,A5 20,A6 0}\nPTP {A1 14,A2 5,A3 0,A4 0,A5 20,A6 0}\n"
      "PTP {A1 5}\nXP1.A1=XP1.A1+45\nPTP_REL {A1 1,A2 0,A3 0,A4 0,A5 0,A6 0}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n");
  ASSERT_EQ(read.log.samples.size(), 2u);
  std::vector<compensation::CompensatedPosture> rows(2);
  for (compensation::CompensatedPosture& row : rows) row.solved = true;
  std::string text = reports::programText(read, "new.src", rows, 1e-6);
  std::replace(text.begin(), text.end(), '\n', ' ');
  expectSays(text, {"2 of 5 joint targets", "1 target is refused", "in space", "(work.txt:8)", "3 targets are refused",
                    "in part only", "(work.txt:5, 6, 7)"});
  expectSays(refusal("DEF PROG()\nDECL AXIS XP1\nXP1.A1=5\nPTP XP1\nEND\n"), {"work.txt:3", "computed"});
}

const std::string kFanuc =
    "/PROG  TEST\n/ATTR\nCOMMENT\t\t= \"PICK/POS 1\";\n/MN\n   1:J P[1] 100% FINE    ;\n/POS\n"
    "P[1:\"home\"]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 10.000 deg,\tJ2= 5.000 deg,\tJ3= 0.000 deg,\n"
    "\tJ4= 0.000 deg,\tJ5= 20.000 deg,\tJ6= 0.000 deg\n};\n/END\n";

TEST(FanucTargets, TheSectionStartsItsLine) {
  EXPECT_EQ(namesOf(program(kFanuc).log), (Names{"P[1]"}));
  EXPECT_EQ(namesOf(log(kFanuc)), (Names{"P[1]"}));
  expectSays(refusal(with(kFanuc, {{"/POS\n", "/POSE\n"}})), {"work.txt:1"});
}

}  // namespace taught_targets_test
}  // namespace stiffscope
