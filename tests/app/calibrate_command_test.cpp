#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/robot/read_urdf.h"
#include "tests/app/command.h"

namespace stiffscope {
namespace calibrate_command_test {

const std::string kDay = STIFFSCOPE_SHARED_DIR "/practice-unloaded/01";

bool dayIsHere() { return std::filesystem::is_directory(kDay); }

TEST(CalibrateCommand, WritesModelsAxesTableAndUrdf) {
  if (!dayIsHere()) GTEST_SKIP() << "the practice days are not here";
  const ScratchFolder scratch;
  const std::string urdf = (scratch.path() / "calibrated.urdf").string(), csv = (scratch.path() / "axes.csv").string();
  const Ran ran =
      runProgram("calibrate '" + kDay + "' --folds 3 --fold-size 2 --json - --urdf '" + urdf + "' --csv '" + csv + "'",
                 scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["folds"], 3);
  EXPECT_EQ(json["fold_size"], 2);
  ASSERT_EQ(json["models"].size(), 4u);
  const char* const names[] = {"nominal", "geometry", "gravity", "effects"};
  for (std::size_t m = 0; m < 4; ++m) {
    const auto& model = json["models"][m];
    EXPECT_EQ(model["model"], names[m]);
    EXPECT_TRUE(model["effects"].is_array());
    EXPECT_GE(model["held_out_max_mm"].get<double>(), model["held_out_mm"].get<double>());
  }
  EXPECT_LT(json["models"][1]["held_out_mm"].get<double>(), json["models"][0]["held_out_mm"].get<double>());
  ASSERT_EQ(json["axes"].size(), 6u);
  EXPECT_TRUE(json["rejected"].is_array());
  EXPECT_TRUE(json["not_identifiable"].is_array());
  const robot::Robot read = robot::readUrdf(urdf, "base_link", "tool0");
  for (std::size_t j = 0; j < 6; ++j) {
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(read.axes_in_base_at_zero[j].direction[k], json["axes"][j]["direction"][k].get<double>(), 1e-9);
  }
  const std::string table = contentsOf(csv);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7);
}

TEST(CalibrateCommand, RefusesFoldsThatAreNone) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("calibrate '" STIFFSCOPE_SOURCE_DIR "/samples/active' --folds 1", scratch.path());
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("--folds: '1': expected 2 to 100"), std::string::npos) << ran.err;
  // A part as large as the day would leave none to hold out.
  const Ran whole =
      runProgram("calibrate '" STIFFSCOPE_SOURCE_DIR "/samples/unloaded' --fold-size 100", scratch.path());
  EXPECT_EQ(whole.status, 2);
  EXPECT_NE(whole.err.find("--fold-size: '100': expected fewer than the day's 100 postures"), std::string::npos)
      << whole.err;
}

TEST(CalibrateCommand, IdentifyNamesIt) {
  if (!dayIsHere()) GTEST_SKIP() << "the practice days are not here";
  const ScratchFolder scratch;
  const Ran ran = runProgram("identify '" + kDay + "'", scratch.path());
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("no joint stiffness"), std::string::npos) << ran.out;
  EXPECT_NE(ran.err.find("calibrate"), std::string::npos) << ran.err;
}

TEST(CalibrateCommand, CommandedAnglesMustBeThere) {
  const ScratchFolder scratch;
  const std::string day = "'" STIFFSCOPE_SOURCE_DIR "/samples/unloaded'";
  for (const std::string command : {"calibrate ", "diagnose "}) {
    const Ran none = runProgram(command + day + " --angles commanded", scratch.path());
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("no joint has a commanded angle (c1_deg to c6_deg"), std::string::npos) << none.err;
    const Ran unknown = runProgram(command + day + " --angles comanded", scratch.path());
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("did you mean 'commanded'?"), std::string::npos) << unknown.err;
  }
}

}  // namespace calibrate_command_test
}  // namespace stiffscope
