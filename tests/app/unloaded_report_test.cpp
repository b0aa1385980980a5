// `report` of days without a load and of days of sweeps alone: files, words, pictures.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>

#include "tests/app/command.h"

namespace stiffscope {
namespace unloaded_report_test {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSample = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active";

/// Keeps the header and the rows of step 0; `step_at` is its column. The wrench's columns become zero.
void keepUnloaded(const fs::path& file, bool states) {
  std::istringstream lines(contentsOf(file));
  std::ofstream kept(file, std::ios::binary);
  const std::regex unloaded("^[^,]+,0,.*"), wrench("(,[^,]*){6}$");
  std::string line;
  for (bool header = true; std::getline(lines, line); header = false) {
    if (!header && !std::regex_match(line, unloaded)) continue;
    kept << (states && !header ? std::regex_replace(line, wrench, ",0,0,0,0,0,0") : line) << '\n';
  }
}

/// The sample's unloaded postures, without load cell; with its sweeps where these are wanted.
fs::path unloadedDay(const ScratchFolder& scratch, bool sweeps) {
  const fs::path folder = scratch.path() / (sweeps ? "unloaded-swept" : "unloaded");
  fs::copy(kSample, folder);
  std::string xml = contentsOf(folder / "campaign.xml");
  for (const std::string element : {"load_cell", "tool", "circle_sweeps", "wrist_sweep"}) {
    if (sweeps && element.ends_with("sweeps")) continue;
    xml = std::regex_replace(xml, std::regex("\\s*<" + element + "\\s[^>]*/>"), "");
  }
  std::ofstream(folder / "campaign.xml", std::ios::binary) << xml;
  keepUnloaded(folder / "loading.csv", false);
  keepUnloaded(folder / "states.csv", true);
  return folder;
}

Ran report(const std::vector<fs::path>& campaigns, const fs::path& out, const ScratchFolder& scratch) {
  std::string words = "report";
  for (const fs::path& campaign : campaigns) words += " '" + campaign.string() + "'";
  return runProgram(words + " --out '" + out.string() + "'", scratch.path());
}

/// Pictures are of their kind: one that shows nothing is white all over.
void expectDrawn(const fs::path& picture) {
  const cv::Mat grey = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(grey.empty()) << picture;
  EXPECT_GT(cv::countNonZero(grey < 200), grey.total() / 500) << picture << " is blank";
}

std::string headOf(const std::string& page) { return page.substr(0, page.find("<main")); }

TEST(UnloadedReport, SpeaksOfAccuracy) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  const Ran ran = report({unloadedDay(scratch, false)}, out, scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string page = contentsOf(out / "report.html");
  EXPECT_NE(page.find("<h1>Absolute accuracy</h1>"), std::string::npos);
  EXPECT_EQ(headOf(page).find("tiffness"), std::string::npos);
  EXPECT_EQ(page.find("id=\"stiffness\""), std::string::npos);
  EXPECT_EQ(page.find(">nan"), std::string::npos);
  std::size_t at = 0;
  for (const char* id : {"conditions", "accuracy", "parameters", "station", "accuracy-gap", "next", "audit", "scope",
                         "provenance", "versions"}) {
    const std::size_t found = page.find("<section id=\"" + std::string(id) + "\">", at);
    ASSERT_NE(found, std::string::npos) << id;
    at = found;
  }
  for (const char* name : {"accuracy-curves", "accuracy-map", "accuracy-before", "over-the-day", "station-drift"})
    expectDrawn(out / (std::string(name) + ".png"));
  const json results = json::parse(contentsOf(out / "results.json"));
  // Fours of postures, as the diagnosis takes them: said where the figures stand.
  EXPECT_NE(page.find("posture i is in fold (i / 4) mod 2"), std::string::npos);
  const json& campaign = results["campaigns"][0];
  for (const char* key : {"preparation", "audit", "frames", "identify", "calibration", "diagnosis"})
    EXPECT_TRUE(campaign.contains(key)) << key;
  EXPECT_EQ(campaign["calibration"]["postures"], 19);
  for (const json& name : results["files"]) EXPECT_TRUE(fs::exists(out / name.get<std::string>())) << name;
}

TEST(UnloadedReport, WithSweepsHasTheirSectionsToo) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  ASSERT_EQ(report({unloadedDay(scratch, true)}, out, scratch).status, 0);
  const std::string page = contentsOf(out / "report.html");
  EXPECT_NE(page.find("<h1>Absolute accuracy</h1>"), std::string::npos);
  EXPECT_LT(page.find("<section id=\"next\">"), page.find("<section id=\"links\">"));
  EXPECT_EQ(page.find("<section id=\"wrist\">"), std::string::npos);
  expectDrawn(out / "circles.png");
}

TEST(UnloadedReport, BesideALoadedDayEachHasItsSections) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  const Ran ran = report({kSample, unloadedDay(scratch, false)}, out, scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string page = contentsOf(out / "report.html");
  EXPECT_NE(page.find("<h1>Absolute accuracy and joint stiffness</h1>"), std::string::npos);
  EXPECT_TRUE(fs::exists(out / "accuracy-map-2.png"));
  EXPECT_TRUE(fs::exists(out / "deflection-1.png"));
  const json results = json::parse(contentsOf(out / "results.json"));
  EXPECT_FALSE(results["campaigns"][0].contains("calibration"));
  EXPECT_TRUE(results["campaigns"][1].contains("calibration"));
}

TEST(UnloadedReport, OfAPracticeDayNamesItsEffect) {
  const fs::path day = STIFFSCOPE_SHARED_DIR "/practice-unloaded/07";
  if (!fs::is_directory(day)) GTEST_SKIP() << "the practice days are not here";
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  ASSERT_EQ(report({day}, out, scratch).status, 0);
  EXPECT_NE(headOf(contentsOf(out / "report.html")).find("transmission error (joint 6)"), std::string::npos);
  expectDrawn(out / "accuracy-after.png");
}

}  // namespace unloaded_report_test
}  // namespace stiffscope
