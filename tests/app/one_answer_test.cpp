#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/command.h"

// The same question put to several commands has one answer, to the last digit.

namespace stiffscope {
namespace one_answer_test {

using nlohmann::json;

json answerOf(const std::string& words, const ScratchFolder& scratch) {
  const Ran ran = runProgram(words + " --json -", scratch.path());
  EXPECT_LE(ran.status, 1) << ran.err;
  return json::parse(ran.out);
}

json reported(const std::string& campaign, const ScratchFolder& scratch) {
  const std::string out = (scratch.path() / "report").string();
  const Ran ran = runProgram("report " + campaign + " --out '" + out + "'", scratch.path());
  EXPECT_LE(ran.status, 1) << ran.err;
  return json::parse(contentsOf(out + "/results.json"))["campaigns"][0];
}

/// `method`: the one that identify shows first.
void expectOneAnswer(const std::string& campaign, const std::string& method) {
  const ScratchFolder scratch;
  const json identified = answerOf("identify " + campaign, scratch),
             diagnosed = answerOf("diagnose " + campaign, scratch), framed = answerOf("frames " + campaign, scratch),
             report = reported(campaign, scratch);
  const json& own = identified["methods"][method];
  EXPECT_EQ(identified["shown_first"]["method"], method);
  EXPECT_EQ(diagnosed["stiffness_by"], method);
  EXPECT_EQ(diagnosed["stiffness_after_nm_per_rad"], own["stiffness_nm_per_rad"]);
  EXPECT_EQ(diagnosed["stiffness_after_sd_nm_per_rad"], own["sd_nm_per_rad"]);
  EXPECT_EQ(diagnosed["stiffness_interval_nm_per_rad"], own["interval_nm_per_rad"]);
  EXPECT_EQ(diagnosed["stiffness_before_nm_per_rad"], identified["apparent"][method]["stiffness_nm_per_rad"]);
  if (!identified["with"]["effects"].empty()) {
    EXPECT_EQ(diagnosed["shrink_together"], identified["with"]["shrink"]);
    EXPECT_EQ(diagnosed["gap"], identified["with"]["gap"]);
  }
  for (const char* key : {"stiffness_nm_per_rad", "interval_nm_per_rad", "budget"})
    EXPECT_EQ(report["identify"]["methods"][method][key], own[key]) << key;
  for (const char* key : {"stiffness_after_nm_per_rad", "stiffness_interval_nm_per_rad", "shrink_together", "gap"})
    EXPECT_EQ(report["diagnose"][key], diagnosed[key]) << key;
  for (const char* key : {"links", "link_lengths_mm", "wrist", "r0_covariance"})
    EXPECT_EQ(report["frames"][key], framed[key]) << key;
  EXPECT_EQ(framed["with"]["effects"], identified["with"]["effects"]);
  EXPECT_EQ(report["identify"]["cautions"], identified["cautions"]);
}

TEST(OneAnswer, OfTheSamples) { expectOneAnswer("'" STIFFSCOPE_SOURCE_DIR "/samples/active'", "dpp"); }

// A day on which the subsets decide for Partial Pose; its effect is one of the measurement and not in the model.
TEST(OneAnswer, OfADayThatShowsPartialPoseFirst) {
  const std::filesystem::path folder = STIFFSCOPE_SHARED_DIR "/practice/15";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  expectOneAnswer("'" + folder.string() + "'", "pp");
}

TEST(OneAnswer, OfADayWithoutALoad) {
  const ScratchFolder scratch;
  const std::string campaign = "'" STIFFSCOPE_SOURCE_DIR "/samples/unloaded'";
  const json diagnosed = answerOf("diagnose " + campaign, scratch), report = reported(campaign, scratch);
  for (const char* key : {"verdict", "classes", "gap", "shrink_together"})
    EXPECT_EQ(report["diagnosis"][key], diagnosed[key]) << key;
  EXPECT_GT(diagnosed["classes"][0]["shrink"]["value"], 0.5);
  // By the folds that it names.
  const json& own = report["calibration"];
  const json again = answerOf(
      "calibrate " + campaign + " --folds " + own["folds"].dump() + " --fold-size " + own["fold_size"].dump(), scratch);
  ASSERT_EQ(own["models"].size(), again["models"].size());
  for (std::size_t m = 0; m < own["models"].size(); ++m) {
    const double held_out = own["models"][m]["held_out_mm"];
    EXPECT_NEAR(held_out, again["models"][m]["held_out_mm"].get<double>(), 3e-3 * held_out)
        << m;  // the report takes the noise that it found
  }
}

const std::string kCable = STIFFSCOPE_SHARED_DIR "/real/fanuc-r2000ic-cable";

TEST(OneAnswer, OfARealDay) {
  if (!std::filesystem::exists(kCable)) GTEST_SKIP() << kCable << " is not here";
  expectOneAnswer("'" + kCable + "'", "pp");
}

// What a class of candidates that the day cannot tell apart leaves open is in the interval of k1: each member's value,
// and that of springs alone. No stiffness is negative, and what no effect explains is said.
TEST(OneAnswer, ARealDaysIntervalHoldsEachMemberOfTheClass) {
  if (!std::filesystem::exists(kCable)) GTEST_SKIP() << kCable << " is not here";
  const ScratchFolder scratch;
  const std::string campaign = "'" + kCable + "'";
  const json identified = answerOf("identify " + campaign, scratch),
             diagnosed = answerOf("diagnose " + campaign, scratch);
  const json& own = identified["methods"]["pp"];
  for (const json& k : own["stiffness_nm_per_rad"]) EXPECT_TRUE(k.is_null() || k.get<double>() > 0.0);
  EXPECT_FALSE(identified["cautions"].empty());
  const double low = own["interval_nm_per_rad"][0][0], high = own["interval_nm_per_rad"][0][1];
  std::vector<double> values{identified["apparent"]["pp"]["stiffness_nm_per_rad"][0]};
  for (const json& effect : diagnosed["classes"][0]["effects"]) {
    const json with = answerOf("identify " + campaign + " --with " + effect.get<std::string>(), scratch);
    values.push_back(with["methods"]["pp"]["stiffness_nm_per_rad"][0]);
  }
  EXPECT_GE(values.size(), 3u);
  for (const double k1 : values) {
    EXPECT_GE(k1, low);
    EXPECT_LE(k1, high);
  }
}

/// samples/active with more attributes in an element of its campaign.xml, in a folder of its own.
std::string declaring(const std::string& element, const std::string& attributes, const ScratchFolder& scratch) {
  const std::filesystem::path folder = scratch.path() / "day";
  std::filesystem::remove_all(folder);
  std::filesystem::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", folder);
  std::string xml = contentsOf(folder / "campaign.xml");
  const std::size_t at = xml.find("<" + element + " ");
  EXPECT_NE(at, std::string::npos);
  xml.insert(at + element.size() + 2, attributes + " ");
  std::ofstream(folder / "campaign.xml") << xml;
  return "'" + folder.string() + "'";
}

double widthOf(const json& identified, std::size_t joint) {
  const json& interval = identified["methods"]["dpp"]["interval_nm_per_rad"][joint];
  return interval[1].get<double>() - interval[0].get<double>();
}

const json* lineOf(const json& identified, const std::string& source) {
  for (const json& line : identified["methods"]["dpp"]["budget"]) {
    if (line["source"] == source) return &line;
  }
  return nullptr;
}

TEST(Declared, EachIsALineOfTheBudgetAndInTheInterval) {
  const ScratchFolder scratch;
  const json plain = answerOf("identify '" STIFFSCOPE_SOURCE_DIR "/samples/active'", scratch);
  EXPECT_EQ(lineOf(plain, "masses"), nullptr);
  EXPECT_EQ(lineOf(plain, "tracker_scale"), nullptr);
  struct Case {
    const char *element, *attributes, *source;
    bool declared_effect;
  };
  for (const Case& one : {Case{"robot", "mass_sigma_percent=\"20\"", "masses", false},
                          Case{"tracker", "scale_sigma_ppm=\"10000\"", "tracker_scale", false},
                          Case{"load_cell", "rpy_sigma_deg=\"5\"", "load_cell_misalignment", true},
                          Case{"load_cell", "xyz_sigma_mm=\"100\"", "load_point_error", true}}) {
    const json declared = answerOf("identify " + declaring(one.element, one.attributes, scratch), scratch);
    const json* line = lineOf(declared, one.source);
    ASSERT_NE(line, nullptr) << one.source;
    EXPECT_EQ(line->value("declared", false), one.declared_effect);
    double largest = 0.0;
    for (const json& u : (*line)["u_nm_per_rad"])
      largest = std::max(largest, u.is_null() ? 0.0 : std::abs(u.get<double>()));
    EXPECT_GT(largest, 0.0) << one.source;
  }
  // A scale 1 % off makes displacements and the long levers of axis 2 1 % too long: d / lever^2 falls by some 1 %.
  const json scaled = answerOf("identify " + declaring("tracker", "scale_sigma_ppm=\"10000\"", scratch), scratch);
  const double k2 = scaled["methods"]["dpp"]["stiffness_nm_per_rad"][1];
  EXPECT_NEAR((*lineOf(scaled, "tracker_scale"))["u_nm_per_rad"][1].get<double>() / k2, 0.01, 0.005);
  EXPECT_GT(widthOf(scaled, 1), widthOf(plain, 1));
}

TEST(Declared, LinkLengthsKnowTheMassesAndTheScale) {
  const ScratchFolder scratch;
  const auto sdOf = [](const json& framed) { return framed["links"][1]["sd_length_mm"].get<double>(); };
  const double plain = sdOf(answerOf("frames '" STIFFSCOPE_SOURCE_DIR "/samples/active'", scratch));
  EXPECT_GT(sdOf(answerOf("frames " + declaring("robot", "mass_sigma_percent=\"20\"", scratch), scratch)), plain);
  const json scaled = answerOf("frames " + declaring("tracker", "scale_sigma_ppm=\"1000\"", scratch), scratch);
  // By hand: a thousandth of the length.
  const double length = scaled["links"][1]["length_mm"].get<double>();
  EXPECT_NEAR(sdOf(scaled), std::hypot(plain, 1e-3 * length), 0.01 * length * 1e-3);
}

}  // namespace one_answer_test
}  // namespace stiffscope
