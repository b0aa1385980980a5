#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/command.h"

namespace stiffscope {
namespace with_option_test {

const std::string kActive = "'" STIFFSCOPE_SOURCE_DIR "/samples/active'";

/// What samples/active.xml says; k1 is never turned by a load that hangs.
const std::array<double, 6> kTruth{7.0e6, 5.6e6, 6.3e6, 0.46e6, 0.35e6, 0.079e6};

TEST(WithOption, TheSamplesStiffnessesComeBackWithTheirBearings) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("identify " + kActive + " --with bearing_tilt --json -", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  for (const char* method : {"cp", "pp", "dpp"}) {
    const auto& own = json["methods"][method];
    EXPECT_TRUE(own["stiffness_nm_per_rad"][0].is_null());
    for (std::size_t j = 1; j < 6; ++j) {
      // Three times the stated interval: one day shows no coverage, but a bearing left in k3 misses by a factor of
      // four.
      const double value = own["stiffness_nm_per_rad"][j].get<double>(), sd = own["sd_nm_per_rad"][j].get<double>();
      EXPECT_NEAR(value, kTruth[j], 6.0 * sd) << method << " k" << j + 1;
      EXPECT_NEAR(value, kTruth[j], 0.03 * kTruth[j]) << method << " k" << j + 1;
      EXPECT_GT(own["contributions"]["effects_rad_per_nm"][j].get<double>(), 0.0);
    }
    const auto &before = json["with"]["methods"][method]["without"], &after = json["with"]["methods"][method]["with"];
    EXPECT_EQ(after["stiffness_nm_per_rad"], own["stiffness_nm_per_rad"]);
    EXPECT_LT(after["rms_residual_mm"].get<double>(), 0.1 * before["rms_residual_mm"].get<double>());
    EXPECT_GT(after["compensated_at_targets"]["held_out"].get<double>(), 0.99);
    EXPECT_LT(before["compensated_at_targets"]["held_out"].get<double>(), 0.92);
  }
  const auto& effects = json["with"]["effects"];
  ASSERT_EQ(effects.size(), 1u);
  EXPECT_EQ(effects[0]["effect"], "bearing_tilt");
  EXPECT_TRUE(effects[0]["enters_compensation"].get<bool>());
  EXPECT_EQ(effects[0]["parameters"][0]["unit"], "rad/Nm");
  EXPECT_GT(json["with"]["explained"].get<double>(), 0.99);
}

TEST(WithOption, WithoutItNothingSaysSo) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("identify " + kActive + " --json -", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_FALSE(json.contains("with"));
  EXPECT_FALSE(json["methods"]["dpp"]["contributions"].contains("effects_rad_per_nm"));
}

TEST(WithOption, BadNamesAreRefusedInOneLine) {
  const ScratchFolder scratch;
  for (const auto& [words, message] : std::vector<std::pair<std::string, std::string>>{
           {"--with bearing_tlt", "(did you mean 'bearing_tilt'?)"},
           {"--with bearing_tilt:9", "expected one of its parts: joint 1, joint 2"},
           {"--with auto,bearing_tilt", "expected auto alone"},
           {"--with", "--with"}}) {
    const Ran ran = runProgram("identify " + kActive + " " + words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(message), std::string::npos) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_TRUE(ran.out.empty());
  }
}

TEST(WithOption, AnEffectOfSizeZeroChangesNothing) {
  const ScratchFolder scratch;
  // The sample's machine has no backlash, and the fit puts it at its bound of zero.
  const Ran text = runProgram("identify " + kActive + " --with backlash", scratch.path());
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("0 (none found)"), std::string::npos);
  const Ran with = runProgram("identify " + kActive + " --with backlash --json -", scratch.path());
  const Ran without = runProgram("identify " + kActive + " --json -", scratch.path());
  ASSERT_EQ(with.status, 0) << with.err;
  EXPECT_EQ(nlohmann::json::parse(with.out)["methods"], nlohmann::json::parse(without.out)["methods"]);
  EXPECT_EQ(runProgram("compensate " + kActive + " --with backlash", scratch.path()).status, 0);
  EXPECT_EQ(runProgram("report " + kActive + " --with backlash --out '" + (scratch.path() / "page").string() + "'",
                       scratch.path())
                .status,
            0);
}

TEST(WithOption, CompensateSaysWhatEnters) {
  const ScratchFolder scratch;
  const Ran ran =
      runProgram("compensate " + kActive + " --with bearing_tilt,load_point_error --json -", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["rows"].size(), 19u);
  ASSERT_EQ(json["with"]["effects"].size(), 2u);
  EXPECT_EQ(json["with"]["effects"][0]["nature"], "machine");
  EXPECT_EQ(json["with"]["effects"][1]["nature"], "load");
}

TEST(WithOption, TheReportIsOfTheImprovedModel) {
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "report").string();
  const Ran ran = runProgram("report " + kActive + " --with bearing_tilt --out '" + out + "'", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(contentsOf(out + "/results.json"));
  const auto& identify = json["campaigns"][0]["identify"];
  EXPECT_EQ(identify["with"]["methods"]["dpp"]["with"]["stiffness_nm_per_rad"],
            identify["methods"]["dpp"]["stiffness_nm_per_rad"]);
  const std::string page = contentsOf(out + "/report.html");
  EXPECT_NE(page.find("id=\"effects\""), std::string::npos);
  EXPECT_NE(page.find("in the model DPP leaves 9 µm rms"), std::string::npos);
}

}  // namespace with_option_test
}  // namespace stiffscope
