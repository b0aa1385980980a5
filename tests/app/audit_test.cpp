#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/app/command.h"

namespace stiffscope {
namespace audit_test {

namespace fs = std::filesystem;

const fs::path kSample = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active";

TEST(AuditCommand, GivesEveryCheckItsFigureLimitAndSource) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("audit '" + kSample.string() + "' --json -", scratch.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["verdict"], "warn");
  EXPECT_EQ(json["made"], 33);
  EXPECT_EQ(json["of"], 34);
  EXPECT_TRUE(json["unanswered"].empty());
  EXPECT_TRUE(json["suspected"].empty());
  EXPECT_TRUE(json["rejected"].empty());
  for (const auto& check : json["checks"]) {
    for (const char* key : {"id", "verdict", "value", "limit", "unit", "where", "message"})
      EXPECT_TRUE(check.contains(key)) << key;
    EXPECT_FALSE(check["message"].get<std::string>().empty()) << check["id"];
    if (check["verdict"] == "not_testable") continue;
    EXPECT_TRUE(check["value"].is_number()) << check["id"];
    EXPECT_TRUE(check["limit"].is_number()) << check["id"];
    EXPECT_FALSE(check["limit_source"].get<std::string>().empty()) << check["id"];
  }
}

/// The sample with one table's lines changed; they are counted from 1, the header.
fs::path spoiltSample(const ScratchFolder& scratch, const std::string& table,
                      const std::function<std::string(int, std::string)>& spoil) {
  const fs::path spoilt = scratch.path() / "spoilt";
  fs::copy(kSample, spoilt);
  std::istringstream lines(contentsOf(spoilt / table));
  std::ofstream out(spoilt / table, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) out << spoil(number, line) << '\n';
  return spoilt;
}

TEST(AuditCommand, AFailedAuditExitsWithOneAndNamesTheRow) {
  const ScratchFolder scratch;
  const fs::path spoilt = spoiltSample(scratch, "loading.csv", [](int number, std::string line) {
    if (number != 100) return line;
    std::size_t comma = 0;  // pose,step,repeat,target,time_s stay; the tracker lost its beam
    for (int k = 0; k < 5; ++k) comma = line.find(',', comma) + 1;
    return line.substr(0, comma) + "0.0000,0.0000,0.0000";
  });
  const Ran ran = runProgram("audit '" + spoilt.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_NE(ran.out.find("not fit to identify from"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("loading.csv:100: lost beam"), std::string::npos) << ran.out;
}

/// The unloaded sample with the lines of its loading that stay.
fs::path partOfUnloaded(const ScratchFolder& scratch, const std::function<bool(const std::string& line)>& stays) {
  const fs::path part = scratch.path() / "part";
  fs::copy(fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "unloaded", part);
  std::istringstream lines(contentsOf(part / "loading.csv"));
  std::ofstream out(part / "loading.csv", std::ios::binary);
  std::string line;
  for (bool header = true; std::getline(lines, line); header = false) {
    if (header || stays(line)) out << line << '\n';
  }
  return part;
}

TEST(AuditCommand, ADayWithoutALoadIsAskedWhetherItCalibrates) {
  const ScratchFolder scratch;
  const fs::path sample = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "unloaded";
  const Ran ran = runProgram("audit '" + sample.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("pass: fit to calibrate from"), std::string::npos) << ran.out;
  const auto json = nlohmann::json::parse(runProgram("audit '" + sample.string() + "' --json -", scratch.path()).out);
  EXPECT_EQ(json["purpose"], "calibrate");
  EXPECT_TRUE(json["unanswered"].empty());
  const auto loaded =
      nlohmann::json::parse(runProgram("audit '" + kSample.string() + "' --json -", scratch.path()).out);
  EXPECT_EQ(loaded["purpose"], "identify");
}

TEST(AuditCommand, TooFewUnloadedReadingsDoNotPass) {
  const ScratchFolder scratch;
  int postures = 0;
  std::string last;
  // Ten readings of one reflector once: 30 coordinates, which calibrate 24 numbers and three reflectors' places not.
  const fs::path few = partOfUnloaded(scratch, [&](const std::string& line) {
    const std::string pose = line.substr(0, line.find(','));
    if (pose == last) return false;
    last = pose;
    return ++postures <= 10;
  });
  const Ran ran = runProgram("audit '" + few.string() + "' --json -", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["verdict"], "not_testable");
  EXPECT_NE(json["unanswered"].dump().find("30 coordinates were read in different postures, and it has 33 numbers"),
            std::string::npos)
      << json["unanswered"];
  EXPECT_NE(json["unanswered"].dump().find("what a reading is worth"), std::string::npos) << json["unanswered"];
}

// Forty times the same posture are many readings and one equation of each kind.
TEST(AuditCommand, OnePostureReadManyTimesDoesNotPass) {
  const ScratchFolder scratch;
  const fs::path day = partOfUnloaded(scratch, [](const std::string&) { return true; });
  std::ifstream states(day / "states.csv");
  std::string header, line, alike;
  std::getline(states, header);
  for (std::string first; std::getline(states, line);) {
    const std::string angles = line.substr(line.find(',', line.find(',', line.find(',') + 1) + 1));
    if (first.empty()) first = angles;
    alike += line.substr(0, line.size() - angles.size()) + first + "\n";
  }
  states.close();
  std::ofstream(day / "states.csv") << header << "\n" << alike;
  const Ran ran = runProgram("audit '" + day.string() + "' --json -", scratch.path());
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_NE(json["unanswered"].dump().find("9 coordinates were read in different postures"), std::string::npos)
      << json["unanswered"];
}

TEST(AuditCommand, ADayWithNothingToTestExitsWithOne) {
  const ScratchFolder scratch;
  const fs::path empty = scratch.path() / "empty";
  fs::create_directory(empty);
  std::ofstream(empty / "campaign.xml")
      << "<campaign format=\"1\" name=\"nothing\" date=\"2026-01-01\">"
         "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\" double_encoder=\"unspecified\"/>"
         "<targets><target id=\"P10\"/></targets></campaign>\n";
  fs::copy(fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "m900ib700.urdf", empty / "robot.urdf");
  const Ran text = runProgram("audit '" + empty.string() + "'", scratch.path());
  EXPECT_EQ(text.status, 1) << text.err;
  EXPECT_NE(text.out.find("nothing: not testable: too little was measured"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("0 of 34 checks could be made"), std::string::npos) << text.out;
  const Ran ran = runProgram("audit '" + empty.string() + "' --json -", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["verdict"], "not_testable");
  EXPECT_EQ(json["made"], 0);
  EXPECT_EQ(json["unanswered"].size(), 4u);
}

TEST(AuditCommand, ADeclaredNoiseThatIsWrongIsSuspected) {
  const ScratchFolder scratch;
  const fs::path spoilt = spoiltSample(scratch, "campaign.xml", [](int, std::string line) {
    for (const auto& [declared, wrong] :
         {std::pair<std::string, std::string>{"range_fixed_um=\"4\"", "range_fixed_um=\"16\""},
          {"range_per_m_um=\"0.6\"", "range_per_m_um=\"2.4\""},
          {"angle_fixed_um=\"6\"", "angle_fixed_um=\"24\""},
          {"angle_per_m_um=\"2.4\"", "angle_per_m_um=\"9.6\""}}) {
      const std::size_t at = line.find(declared);
      if (at != std::string::npos) line.replace(at, declared.size(), wrong);
    }
    return line;
  });
  const auto json = nlohmann::json::parse(runProgram("audit '" + spoilt.string() + "' --json -", scratch.path()).out);
  ASSERT_EQ(json["suspected"].size(), 1u);
  const auto& one = json["suspected"][0];
  EXPECT_EQ(one["mistake"], "noise_declared");
  EXPECT_EQ(one["where"], "tracker");
  EXPECT_NE(one["remedy"].get<std::string>().find("angle_fixed_um"), std::string::npos);
  EXPECT_LT(one["before"], 0.4);
  EXPECT_NEAR(one["after"].get<double>(), 1.0, 0.3);
}

TEST(AuditCommand, ACampaignThatIsNotThereIsBadInput) {
  const ScratchFolder scratch;
  EXPECT_EQ(runProgram("audit nowhere", scratch.path()).status, 2);
}

// Angles in radians under q1_deg..q6_deg: nothing could be told apart in such a day, and looking for it takes a minute.
TEST(AuditCommand, WhatCannotBeIsNotSearchedForEffects) {
  const ScratchFolder scratch;
  const fs::path spoilt = spoiltSample(scratch, "states.csv", [](int number, const std::string& line) {
    if (number == 1) {
      EXPECT_EQ(line.rfind("pose,step,time_s,q1_deg", 0), 0u);
      return line;
    }
    std::istringstream cells(line);
    std::string cell, spoilt_line;
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (column >= 3 && column < 9) cell = std::to_string(std::stod(cell) * 0.0174533);
      spoilt_line += (column > 0 ? "," : "") + cell;
    }
    return spoilt_line;
  });
  const Ran ran = runProgram("audit '" + spoilt.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_NE(ran.out.find("units, angles or the tracker's"), std::string::npos) << ran.out;
  EXPECT_EQ(ran.out.find("could be told apart"), std::string::npos) << ran.out;
  EXPECT_NE(runProgram("audit '" + kSample.string() + "'", scratch.path()).out.find("could be told apart"),
            std::string::npos);
}

}  // namespace audit_test
}  // namespace stiffscope
