#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/command.h"

namespace stiffscope {
namespace compensate_command_test {

namespace fs = std::filesystem;

const std::string kActive = STIFFSCOPE_SOURCE_DIR "/samples/active";
const std::string kQuick = " --springs-only --method pp ";

std::string quoted(const fs::path& path) { return " '" + path.string() + "' "; }

/// The sample with k1 known from elsewhere, which its hanging weights do not show.
fs::path dayWithK1(const ScratchFolder& scratch, const std::string& more = "") {
  const fs::path day = scratch.path() / "day";
  fs::copy(kActive, day);
  std::string xml = contentsOf(day / "campaign.xml");
  const std::string line =
      "<known_stiffness joint=\"1\" nm_per_rad=\"7.1e6\" sd_nm_per_rad=\"2e5\" source=\"maker\"/>" + more;
  xml.insert(xml.find("<tool"), line);
  std::ofstream(day / "campaign.xml") << xml;
  return day;
}

std::vector<std::vector<std::string>> cellsOf(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

std::size_t column(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::find(header.begin(), header.end(), name);
  EXPECT_NE(found, header.end()) << name;
  return static_cast<std::size_t>(found - header.begin());
}

TEST(CompensateOut, IsTheJsonInColumns) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "commands.csv";
  const Ran ran = runProgram("compensate '" + kActive + "'" + kQuick + "--json - --out" + quoted(out), scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto rows = nlohmann::json::parse(ran.out)["rows"];
  const auto cells = cellsOf(contentsOf(out));
  ASSERT_EQ(cells.size(), rows.size() + 1);
  const std::size_t command = column(cells[0], "c1_deg"), deflection = column(cells[0], "deflection_z_mm");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(cells[i + 1][0], rows[i]["pose"]);
    for (std::size_t j = 0; j < 6; ++j)  // six decimals
      EXPECT_NEAR(std::stod(cells[i + 1][command + j]), rows[i]["command_deg"][j].get<double>(), 6e-7);
    EXPECT_NEAR(std::stod(cells[i + 1][deflection]), rows[i]["tcp_deflection_mm"][2].get<double>(), 6e-6);
  }
}

const std::string kProgram =
    "DEFDAT  WORK PUBLIC\r\nDECL AXIS XP1={A1 5.0,A2 -80.0,A3 80.0,A4 0.0,A5 -60.0,A6 0.0}\r\n"
    "DECL E6POS XP2={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0,S 2,T 35}\r\n"
    "DECL AXIS XP3={A1 -10.0,A2 -100.0,A3 75.0,A4 20.0,A5 -70.0,A6 10.0}\r\nENDDAT\r\n";

/// Tables of controllers that count joints 2 and 3 from the horizontal: 90 deg less and more.
void restate(const fs::path& day) {
  for (const char* table : {"circle_sweeps.csv", "wrist_sweep.csv", "states.csv"}) {
    auto rows = cellsOf(contentsOf(day / table));
    const std::size_t q2 = column(rows[0], "q2_deg"), q3 = column(rows[0], "q3_deg");
    std::ofstream out(day / table);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i > 0) {
        rows[i][q2] = std::to_string(std::stod(rows[i][q2]) - 90.0);
        rows[i][q3] = std::to_string(std::stod(rows[i][q3]) + 90.0);
      }
      for (std::size_t k = 0; k < rows[i].size(); ++k) out << (k > 0 ? "," : "") << rows[i][k];
      out << "\n";
    }
  }
}

// The same targets in a table of postures and in a program, both as the controller states them: the commands agree.
TEST(CompensateProgram, ReplacesTargetsByTheControllersFigures) {
  const ScratchFolder scratch;
  const fs::path day = dayWithK1(
      scratch, "<joint_reading joint=\"2\" offset_deg=\"90\"/><joint_reading joint=\"3\" offset_deg=\"-90\"/>");
  restate(day);
  const fs::path program = scratch.path() / "work.dat", out = scratch.path() / "out.dat",
                 postures = scratch.path() / "postures.csv";
  std::ofstream(program) << kProgram;
  std::ofstream(postures) << "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\n"
                             "XP1,5,-80,80,0,-60,0,0,100,900,10,0,0\nXP3,-10,-100,75,20,-70,10,0,100,900,10,0,0\n";
  const Ran by_program = runProgram("compensate" + quoted(day) + kQuick + "--program" + quoted(program) + "--out" +
                                        quoted(out) + "--wrench 0,100,900,10,0,0 --json -",
                                    scratch.path());
  ASSERT_EQ(by_program.status, 0) << by_program.err;
  const Ran by_postures =
      runProgram("compensate" + quoted(day) + kQuick + "--postures" + quoted(postures) + "--json -", scratch.path());
  ASSERT_EQ(by_postures.status, 0) << by_postures.err;
  const auto json = nlohmann::json::parse(by_program.out), other = nlohmann::json::parse(by_postures.out);
  EXPECT_EQ(json["program"]["replaced"], 2);
  EXPECT_EQ(json["program"]["format"], "kuka_krl");
  EXPECT_EQ(json["program"]["in_space"], nlohmann::json::array({3}));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(json["rows"][i]["command_deg"], other["rows"][i]["command_deg"]);
  // What a terminal shows of them are the controller's figures, too.
  const Ran text = runProgram("compensate" + quoted(day) + kQuick + "--postures" + quoted(postures), scratch.path());
  const double command_2 = json["rows"][0]["command_deg"][1].get<double>() - 90.0;
  EXPECT_NE(text.out.find(fmt::format("{:10.4f}", command_2)), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("Angles as the controller states them (joint_reading)."), std::string::npos);
  // The program as it was, the commands written into it by hand: 90 deg off and with four decimals.
  std::string expected = kProgram;
  const std::array<std::array<std::string, 6>, 2> written{
      {{"5.0", "-80.0", "80.0", "0.0", "-60.0", "0.0"}, {"-10.0", "-100.0", "75.0", "20.0", "-70.0", "10.0"}}};
  std::size_t at = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const double figure = json["rows"][i]["command_deg"][j].get<double>() + (j == 1 ? -90.0 : (j == 2 ? 90.0 : 0.0));
      EXPECT_NEAR(json["rows"][i]["reading_deg"][j].get<double>(), figure, 1e-9);
      const std::string text = fmt::format("{:.4f}", figure);
      // What is the same to four decimals stays as it is written.
      if (std::abs(std::stod(text) - std::stod(written[i][j])) < 5e-5) continue;
      const std::string key = "A" + std::to_string(j + 1) + " " + written[i][j];
      at = expected.find(key, at);
      ASSERT_NE(at, std::string::npos) << key;
      expected.replace(at + 3, written[i][j].size(), text);
    }
  }
  EXPECT_EQ(contentsOf(out), expected);
  EXPECT_LT(json["program"]["rounding_mm"].get<double>(), 0.01);
}

// What is planned for such a controller can be driven to, and compensated as it stands.
TEST(Plan, StatesAnglesAsTheControllerDoes) {
  const ScratchFolder scratch;
  const fs::path day = dayWithK1(
      scratch, "<joint_reading joint=\"2\" offset_deg=\"90\"/><joint_reading joint=\"3\" offset_deg=\"-90\"/>");
  restate(day);
  const fs::path out = scratch.path() / "plan.csv";
  const Ran planned =
      runProgram("plan" + quoted(day) + "--springs-only --postures 3 --candidates 100 --out" + quoted(out) + "--json -",
                 scratch.path());
  ASSERT_EQ(planned.status, 0) << planned.err;
  const auto plan = nlohmann::json::parse(planned.out);
  const auto cells = cellsOf(contentsOf(out));
  const std::size_t q2 = column(cells[0], "q2_deg"), q3 = column(cells[0], "q3_deg");
  for (std::size_t i = 0; i < plan["rows"].size(); ++i) {
    const auto& row = plan["rows"][i];
    EXPECT_NEAR(row["reading_deg"][1].get<double>(), row["q_deg"][1].get<double>() - 90.0, 1e-9);
    EXPECT_NEAR(row["reading_deg"][2].get<double>(), row["q_deg"][2].get<double>() + 90.0, 1e-9);
    EXPECT_NEAR(std::stod(cells[i + 1][q2]), row["reading_deg"][1].get<double>(), 6e-6);
    EXPECT_NEAR(std::stod(cells[i + 1][q3]), row["reading_deg"][2].get<double>(), 6e-6);
  }
  const Ran compensated =
      runProgram("compensate" + quoted(day) + kQuick + "--postures" + quoted(out) + "--json -", scratch.path());
  ASSERT_EQ(compensated.status, 0) << compensated.err;
  const auto rows = nlohmann::json::parse(compensated.out)["rows"];
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < 6; ++j)
      EXPECT_NEAR(rows[i]["q_deg"][j].get<double>(), plan["rows"][i]["q_deg"][j].get<double>(), 6e-6);
}

const std::string kPath =
    "pose,x_mm,y_mm,z_mm,i,j,k\na,0,0,0,0,0,1\nb,30,0,0,0,0,1\nc,60,10,0,0.1,0,0.995\nd,3000,0,0,0,0,1\n";
const std::string kCell = " --tool 120,0,300,0,45,0 --workpiece 1900,100,900,0,0,0 ";

TEST(CompensatePath, WritesCommandsAndPicture) {
  const ScratchFolder scratch;
  const fs::path day = dayWithK1(scratch), path = scratch.path() / "path.csv", out = scratch.path() / "out.csv",
                 picture = scratch.path() / "path.png";
  std::ofstream(path) << kPath;
  const Ran ran = runProgram("compensate" + quoted(day) + kQuick + "--path" + quoted(path) + kCell +
                                 "--cutting feed_mm=0.5,depth_mm=4,width_mm=15,diameter_mm=20,specific_force_n_mm2=900 "
                                 "--json - --out" +
                                 quoted(out) + "--picture" + quoted(picture),
                             scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["summary"]["compensated"], 3);
  EXPECT_EQ(json["joints"]["reached"], 3);
  EXPECT_TRUE(json["joints"]["turn_free"]);
  const auto& last = json["rows"][3];
  EXPECT_TRUE(last["command_deg"].is_null());
  EXPECT_EQ(last["refused"].get<std::string>().rfind("no joint angles hold the tool there", 0), 0u) << last;
  const auto& first = json["rows"][0];
  // The offset is about the deflection turned round, to the second order.
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(first["offset"]["shift_mm"][k].get<double>(), -first["deflection_in_workpiece_mm"][k].get<double>(),
                0.05);
  const auto cells = cellsOf(contentsOf(out));
  ASSERT_EQ(cells.size(), 5u);
  EXPECT_NEAR(std::stod(cells[1][column(cells[0], "c1_deg")]), first["command_deg"][0].get<double>(), 6e-7);
  EXPECT_NEAR(std::stod(cells[2][column(cells[0], "along_mm")]), 30.0, 1e-9);
  EXPECT_EQ(contentsOf(picture).substr(1, 3), "PNG");
}

// The branch to stay on is named by the controller's figures, as all angles that are given.
TEST(CompensatePath, StartsAtTheControllersFigures) {
  const ScratchFolder plain, restated;
  const fs::path own = dayWithK1(plain);
  const fs::path day = dayWithK1(
      restated, "<joint_reading joint=\"2\" offset_deg=\"90\"/><joint_reading joint=\"3\" offset_deg=\"-90\"/>");
  restate(day);
  const auto jointsOf = [](const ScratchFolder& scratch, const fs::path& campaign, const std::string& start) {
    const fs::path path = scratch.path() / "path.csv";
    std::ofstream(path) << kPath;
    const Ran ran = runProgram("compensate" + quoted(campaign) + kQuick + "--path" + quoted(path) + kCell +
                                   "--wrench 0,0,-500,0,0,0 --json - --start " + start,
                               scratch.path());
    EXPECT_NE(ran.status, 2) << ran.err;
    return nlohmann::json::parse(ran.out)["rows"][0]["q_deg"];
  };
  // The best branch, and the same with the wrist turned round, which differ by half a turn of joint 4.
  const auto q = jointsOf(plain, own, "0,20,-20,0,30,0"), turned = jointsOf(plain, own, "0,20,-20,180,-30,180");
  ASSERT_TRUE(q.is_array() && turned.is_array()) << q << turned;
  const auto figures = jointsOf(restated, day, "0,-70,70,0,30,0"),
             turned_figures = jointsOf(restated, day, "0,-70,70,180,-30,180");
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_NEAR(figures[j].get<double>(), q[j].get<double>(), 0.05) << j;
    EXPECT_NEAR(turned_figures[j].get<double>(), turned[j].get<double>(), 0.05) << j;
  }
}

TEST(CompensateCommand, RefusesWhatDoesNotGoTogether) {
  const ScratchFolder scratch;
  const fs::path path = scratch.path() / "path.csv", program = scratch.path() / "work.dat",
                 space = scratch.path() / "space.dat";
  std::ofstream(path) << kPath;
  std::ofstream(program) << kProgram;
  std::ofstream(space) << "DEFDAT X\nDECL E6POS XP2={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}\nENDDAT\n";
  const std::string by_path = "--path" + quoted(path), by_program = "--program" + quoted(program) + "--out o.dat ";
  const std::string cut = "--cutting feed_mm=0.5,depth_mm=4,width_mm=15,diameter_mm=20,specific_force_n_mm2=900";
  const std::pair<std::string, std::string> refused[] = {
      {by_path + "--wrench 1,0,0,0,0,0", "expected --tool"},
      {by_path + kCell, "expected the process load once"},
      {by_path + kCell + "--wrench 1,0,0,0,0,0 --wrench-axes feet",
       "'feet': expected workpiece, tool, feed, base_link"},
      {by_path + kCell + "--cutting feed_mm=0.5", "expected depth_mm=VALUE, too"},
      {by_path + kCell + "--cutting feed_m=0.5", "did you mean 'feed_mm'"},
      {by_path + kCell + cut + ",feed_mm=-1", "'feed_mm=-1': expected a number above 0"},
      {by_path + kCell + cut + ",width_mm=30", "no larger than diameter_mm"},
      {"--program" + quoted(program) + "--wrench 1,0,0,0,0,0", "expected --out"},
      {by_program, "expected the load"},
      {by_program + "--wrench 1,0,0,0,0,0 --wrench-axes base_link", "expected --tool"},
      {"--program" + quoted(space) + "--out o.dat --wrench 1,0,0,0,0,0", "space.dat:2: expected joint targets"},
      {"--wrench 1,0,0,0,0,0", "needs --program or --path"}};
  for (const auto& [words, said] : refused) {
    const Ran ran = runProgram("compensate '" + kActive + "'" + kQuick + words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << words << "\n" << ran.err;
  }
  EXPECT_FALSE(fs::exists("o.dat"));
}

}  // namespace compensate_command_test
}  // namespace stiffscope
