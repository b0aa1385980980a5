#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/robot/kinematics.h"
#include "core/robot/read_urdf.h"
#include "tests/app/command.h"

namespace stiffscope {
namespace export_command_test {

namespace fs = std::filesystem;

const std::string kActive = " '" STIFFSCOPE_SOURCE_DIR "/samples/active' ";
const std::string kUnloaded = " '" STIFFSCOPE_SOURCE_DIR "/samples/unloaded' ";

std::string quoted(const fs::path& path) { return " '" + path.string() + "' "; }

nlohmann::json exported(const std::string& words, const ScratchFolder& scratch, const fs::path& out) {
  const Ran ran = runProgram("export " + words + " --json - --out" + quoted(out), scratch.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  return ran.status == 0 ? nlohmann::json::parse(ran.out) : nlohmann::json();
}

TEST(ExportCommand, MjcfHasTheSpringsThatIdentifyFinds) {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "arm.xml";
  const auto json = exported("mjcf" + kActive + "--springs-only --method pp", scratch, file);
  const Ran identify = runProgram("identify" + kActive + "--springs-only --method pp --json -", scratch.path());
  const auto stiffness = nlohmann::json::parse(identify.out)["methods"]["pp"]["stiffness_nm_per_rad"];
  EXPECT_EQ(json["format"], "mjcf");
  EXPECT_EQ(json["method"], "pp");
  std::map<std::string, double> springs;
  int drives = 0;
  for (const auto& joint : json["joints"]) {
    drives += joint["kind"] == "drive";
    if (joint["kind"] == "turn_spring") springs[joint["name"]] = joint["stiffness"];
    EXPECT_NE(joint["kind"], "shift_spring");
  }
  EXPECT_EQ(drives, 6);
  ASSERT_EQ(springs.size(), 5u);  // k1 is not identifiable
  for (int joint = 2; joint <= 6; ++joint) {
    const double k = stiffness[static_cast<std::size_t>(joint - 1)];
    EXPECT_NEAR(springs.at("joint_" + std::to_string(joint) + "_spring"), k, 1e-9 * k);
  }
  ASSERT_EQ(json["remarks"].size(), 1u);
  const std::string said = json["remarks"][0];
  EXPECT_EQ(said, "joint 1 has no spring: the day does not tell k1");
  const std::string text = contentsOf(file);
  EXPECT_NE(text.find("<!-- " + said + " -->"), std::string::npos);
  EXPECT_NE(text.find("gravity=\"0 0 -9.80665\""), std::string::npos);
}

TEST(ExportCommand, EffectsOfTheModelAreSpringsBesides) {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "arm.sdf";
  const auto json = exported("sdf" + kActive, scratch, file);
  int tilts = 0;
  for (const auto& joint : json["joints"])
    tilts += joint["name"].get<std::string>().find("_tilt_") != std::string::npos;
  EXPECT_EQ(tilts, 12);
  std::vector<std::string> sites;
  for (const auto& site : json["sites"]) sites.push_back(site["name"]);
  EXPECT_EQ(sites, (std::vector<std::string>{"R0", "tool0", "tcp", "load_point", "P10", "P11", "P12"}));
  const std::string text = contentsOf(file);
  EXPECT_NE(text.find("<sdf version=\"1.9\">"), std::string::npos);
  EXPECT_NE(text.find("<frame name=\"P11\""), std::string::npos);
}

TEST(ExportCommand, AKnownStiffnessFillsAJointThatTheDayDoesNotTell) {
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "campaign";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
  std::string xml = contentsOf(campaign / "campaign.xml");
  xml.insert(xml.find("<circle_sweeps"),
             R"(<known_stiffness joint="1" nm_per_rad="7e6" sd_nm_per_rad="2e5" source="maker"/>)");
  std::ofstream(campaign / "campaign.xml") << xml;
  const auto json = exported("mjcf" + quoted(campaign) + "--springs-only", scratch, scratch.path() / "arm.xml");
  EXPECT_TRUE(json["remarks"].empty());
  EXPECT_EQ(json["joints"][1]["name"], "joint_1_spring");
  EXPECT_NEAR(json["joints"][1]["stiffness"].get<double>(), 7e6, 1.0);
}

TEST(ExportCommand, UrdfIsThatOfCalibrate) {
  const ScratchFolder scratch;
  for (const std::string& day : {kActive, kUnloaded}) {
    const fs::path by_export = scratch.path() / "export.urdf", by_calibrate = scratch.path() / "calibrate.urdf";
    EXPECT_EQ(exported("urdf" + day, scratch, by_export)["geometry"], "unloaded_postures");
    const Ran ran = runProgram("calibrate" + day + "--urdf" + quoted(by_calibrate), scratch.path());
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(contentsOf(by_export), contentsOf(by_calibrate));
    EXPECT_NE(contentsOf(by_export).find("Not the maker's file."), std::string::npos);
  }
}

// Of a day of sweeps alone: distances between consecutive axes are those that `frames` states.
TEST(ExportCommand, UrdfOfSweepsHasTheirAxes) {
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "campaign", file = scratch.path() / "arm.urdf";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
  std::string xml = contentsOf(campaign / "campaign.xml");
  for (const std::string element : {"<loading file=\"loading.csv\"/>", "<states file=\"states.csv\"/>"})
    xml.erase(xml.find(element), element.size());
  std::ofstream(campaign / "campaign.xml") << xml;
  EXPECT_EQ(exported("urdf" + quoted(campaign), scratch, file)["geometry"], "sweeps");
  const robot::Robot arm = robot::readUrdf(file, "base_link", "tool0");
  const Ran frames = runProgram("frames" + quoted(campaign) + "--json -", scratch.path());
  ASSERT_EQ(frames.status, 0) << frames.err;
  const auto links = nlohmann::json::parse(frames.out)["links"];
  ASSERT_EQ(links.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const metrology::Line &a = arm.axes_in_base_at_zero[k], &b = arm.axes_in_base_at_zero[k + 1];
    const double angle = std::acos(std::min(1.0, std::abs(a.direction.dot(b.direction)))) * 180.0 / M_PI;
    EXPECT_NEAR(angle, links[k]["angle_deg"].get<double>(), 1e-6) << k;
  }
}

TEST(ExportCommand, RefusesWhatItCannotExport) {
  const ScratchFolder scratch;
  const std::string out = " --out" + quoted(scratch.path() / "arm.xml");
  const std::pair<std::string, const char*> cases[] = {
      {"export", "subcommand"},
      {"export mjcf" + kActive, "--out"},
      {"export mjcf" + kUnloaded + out, "calibrate"},
      {"export mjcf" + kActive + "--method all" + out, "--method: 'all': expected one of cp, pp or dpp"},
      {"export sdf" + kActive + "--with bearing_tlt" + out, "did you mean 'bearing_tilt'?"},
      {"export mjcf" + kActive + "--json" + quoted(scratch.path() / "arm.xml") + out,
       "expected another file for --json than for --out"},
  };
  for (const auto& [words, said] : cases) {
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << words << "\n" << ran.err;
    EXPECT_FALSE(fs::exists(scratch.path() / "arm.xml")) << words;
  }
}

TEST(ExportCommand, WritesOverNoInput) {
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "campaign";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
  const std::string before = contentsOf(campaign / "robot.urdf");
  for (const char* format : {"urdf", "mjcf", "sdf"}) {
    const Ran ran = runProgram(
        std::string("export ") + format + quoted(campaign) + "--out" + quoted(campaign / "robot.urdf"), scratch.path());
    EXPECT_EQ(ran.status, 2) << format;
    EXPECT_NE(ran.err.find("it is an input of this run"), std::string::npos) << ran.err;
    EXPECT_EQ(contentsOf(campaign / "robot.urdf"), before);
  }
}

}  // namespace export_command_test
}  // namespace stiffscope
