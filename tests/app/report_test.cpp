#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/command.h"

// The report's folder: what is written, and what of an earlier report is taken away.

namespace stiffscope {
namespace report_test {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSample = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active";

/// The sample without its loads: a day of sweeps alone, without those that `without` names. The load cell stays
/// declared.
fs::path sweepsOnly(const ScratchFolder& scratch, const std::string& without = {}) {
  const fs::path folder = scratch.path() / "sweeps";
  fs::copy(kSample, folder);
  std::string xml = contentsOf(folder / "campaign.xml");
  for (const std::string element : {"loading", "states", without.c_str()}) {
    if (!element.empty()) xml = std::regex_replace(xml, std::regex("\\s*<" + element + "\\s[^>]*/>"), "");
  }
  std::ofstream(folder / "campaign.xml", std::ios::binary) << xml;
  return folder;
}

Ran report(const fs::path& campaign, const fs::path& out, const ScratchFolder& scratch) {
  return runProgram("report '" + campaign.string() + "' --out '" + out.string() + "'", scratch.path());
}

std::vector<std::string> picturesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Report, HasTheAuditItsRejectedReadingsAndItsFiles) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  const Ran ran = report(kSample, out, scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json results = json::parse(contentsOf(out / "results.json"));
  const json& campaign = results["campaigns"][0];
  EXPECT_EQ(campaign["audit"]["verdict"], "warn");
  EXPECT_GT(campaign["audit"]["checks"].size(), 20u);
  EXPECT_EQ(campaign["preparation"]["raw"], false);
  for (const json& name : results["files"]) EXPECT_TRUE(fs::exists(out / name.get<std::string>())) << name;
  const std::string page = contentsOf(out / "report.html");
  EXPECT_NE(page.find("<section id=\"audit\">"), std::string::npos);
  EXPECT_NE(page.find("The readings are good enough to identify stiffnesses from; the audit warns of"),
            std::string::npos);
  EXPECT_NE(page.find("No reading was rejected."), std::string::npos);
  EXPECT_NE(page.find("none left out; no drift of the station taken off"), std::string::npos);
}

TEST(Report, OfAMistakenDayBeginsWithTheMistakeAndNotWithWhatItLooksLike) {
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "flipped", out = scratch.path() / "out";
  fs::copy(kSample, campaign);
  std::istringstream lines(contentsOf(campaign / "states.csv"));
  std::ofstream flipped(campaign / "states.csv", std::ios::binary);
  std::size_t column = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (column == 0)
      column = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), "fz_n") - cells.begin());
    else if (cells.at(column).starts_with('-'))
      cells[column].erase(0, 1);
    else
      cells[column].insert(0, "-");
    for (std::size_t i = 0; i < cells.size(); ++i) flipped << (i > 0 ? "," : "") << cells[i];
    flipped << "\n";
  }
  flipped.close();
  const Ran ran = report(campaign, out, scratch);
  ASSERT_LE(ran.status, 1) << ran.err;
  const std::string page = contentsOf(out / "report.html");
  const std::string first = page.substr(page.find("<header>"), page.find("<main") - page.find("<header>"));
  EXPECT_NE(
      first.find("The audit suspects a mistake in the files, wrench sign of the columns fz_n of states.csv: turn the "
                 "sign of fz_n, then make this report again."),
      std::string::npos);
  EXPECT_NE(first.find("class=\"judgement bad\""), std::string::npos);
  EXPECT_EQ(first.find("tare the cell"), std::string::npos);  // what a diagnosis makes of the wrong sign
  EXPECT_EQ(first.find("Besides joint springs"), std::string::npos);
}

TEST(Report, LimitsAreDecidedByTheWholeInterval) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out", limits = scratch.path() / "limits.csv";
  const fs::path sweeps = sweepsOnly(scratch);
  // Millimetres off in the sample, and known to millimetres, since nobody knows how far its arm sags.
  const auto run = [&](const std::string& most) {
    std::ofstream(limits) << "name,least,most,reason\nlink_difference_largest_mm,," << most << ",drawing 7\n";
    return runProgram(
        "report '" + sweeps.string() + "' --limits '" + limits.string() + "' --out '" + out.string() + "'",
        scratch.path());
  };
  const auto verdict = [&] { return json::parse(contentsOf(out / "results.json"))["campaigns"][0]["limits"][0]; };
  EXPECT_EQ(run("100").status, 0);
  EXPECT_EQ(verdict()["verdict"], "pass");
  const double value = verdict()["value"], high = verdict()["high"];
  EXPECT_EQ(run(std::to_string(0.99 * value)).status, 1);
  EXPECT_EQ(verdict()["verdict"], "fail");
  EXPECT_FALSE(verdict()["in_guard_band"].get<bool>());
  EXPECT_EQ(run(std::to_string((value + high) / 2)).status, 1);
  EXPECT_TRUE(verdict()["in_guard_band"].get<bool>());
  EXPECT_NE(contentsOf(out / "report.html").find("Decision rule: guarded acceptance"), std::string::npos);
  EXPECT_TRUE(fs::exists(out / "limits.csv"));
  const Ran refused = run("two");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("limits.csv:2: most: 'two': "), std::string::npos) << refused.err;
}

TEST(Report, SweepsAloneGiveIdentifyAndDiagnoseNothingToUse) {
  const ScratchFolder scratch;
  const std::string folder = "'" + sweepsOnly(scratch).string() + "'";
  const fs::path file = scratch.path() / "result.json";
  for (const std::string command : {"identify", "identify --springs-only", "diagnose"}) {
    SCOPED_TRACE(command);
    const Ran ran = runProgram(command + " " + folder + " --json '" + file.string() + "'", scratch.path());
    EXPECT_EQ(ran.status, 1) << ran.err;  // the day is as it should be, and serves another purpose
    EXPECT_NE((ran.out + ran.err).find("no 'states': joint angles and load-cell readings are needed"),
              std::string::npos)
        << ran.out << ran.err;
    const json result = json::parse(contentsOf(file));
    if (command == "diagnose") {
      EXPECT_EQ(result["usable"], false);
      continue;
    }
    for (const char* method : {"cp", "pp", "dpp"}) {
      EXPECT_NE(result["methods"][method]["unavailable"].get<std::string>().find("no 'states'"), std::string::npos);
    }
  }
  // An unloaded day as well, which another command is for.
  const fs::path unloaded = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "unloaded";
  const Ran ran = runProgram("identify '" + unloaded.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_NE(ran.err.find("`stiffscope calibrate` fits unloaded postures"), std::string::npos) << ran.err;
}

TEST(Report, SweepsAloneGiveFramesAuditAndReasons) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  const Ran ran = report(sweepsOnly(scratch), out, scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json results = json::parse(contentsOf(out / "results.json"));
  const json& campaign = results["campaigns"][0];
  EXPECT_EQ(campaign["frames"]["axes"].size(), 6u);
  EXPECT_EQ(campaign["frames"]["axes"][0]["from"], "sweeps");
  for (const char* method : {"cp", "pp", "dpp"}) {
    const auto reason = campaign["identify"]["methods"][method]["unavailable"].get<std::string>();
    EXPECT_NE(reason.find("no 'states'"), std::string::npos) << reason;
  }
  const std::string page = contentsOf(out / "report.html");
  EXPECT_NE(page.find("<h1>Geometry by circle sweeps</h1>"), std::string::npos);
  EXPECT_EQ(page.substr(0, page.find("<main")).find("tiffness"), std::string::npos);
  for (const char* id : {"stiffness", "left-out", "subsets"})
    EXPECT_EQ(page.find("<section id=\"" + std::string(id) + "\">"), std::string::npos) << id;
  EXPECT_NE(page.find("<section id=\"audit\">"), std::string::npos);
  EXPECT_EQ(page.find(">nan"), std::string::npos);
  EXPECT_EQ(picturesIn(out),
            (std::vector<std::string>{"circles.png", "station-drift.png", "sweeps.png", "wrist-sphere.png"}));
  EXPECT_NE(page.find("<b>6 of 6</b>"), std::string::npos);  // axes, not stiffnesses
  EXPECT_EQ(page.find("id=\"compensation\""), std::string::npos);
}

TEST(Report, TakesAwayTheEarlierOnesPicturesAndNothingElse) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "out";
  ASSERT_EQ(report(kSample, out, scratch).status, 0);
  const auto first = picturesIn(out);
  ASSERT_FALSE(first.empty());
  std::ofstream(out / "mine.png") << "a picture of somebody else's";
  std::ofstream(scratch.path() / "outside.png") << "not even here";
  // A list that names what is not a picture of its own does not reach it.
  json earlier = json::parse(contentsOf(out / "results.json"));
  earlier["files"].push_back("../outside.png");
  std::ofstream(out / "notes.txt") << "notes";
  earlier["files"].push_back("notes.txt");
  std::ofstream(out / "results.json") << earlier;
  ASSERT_EQ(report(sweepsOnly(scratch), out, scratch).status, 0);
  EXPECT_EQ(picturesIn(out), (std::vector<std::string>{"circles.png", "mine.png", "station-drift.png", "sweeps.png",
                                                       "wrist-sphere.png"}));
  EXPECT_TRUE(fs::exists(scratch.path() / "outside.png"));
  EXPECT_TRUE(fs::exists(out / "notes.txt"));
}

TEST(Frames, NominalValuesAreMarked) {
  const ScratchFolder scratch;
  const fs::path folder = sweepsOnly(scratch, "circle_sweeps");
  const json frames = json::parse(runProgram("frames '" + folder.string() + "' --json -", scratch.path()).out);
  EXPECT_EQ(frames["r0_placed_by"], "nominal");
  for (const json& axis : frames["axes"]) EXPECT_EQ(axis["from"], "nominal");
  for (const json& link : frames["links"]) EXPECT_EQ(link["from"], "nominal");
  for (const json& source : frames["link_lengths_from"]) EXPECT_EQ(source, "nominal");
  EXPECT_EQ(frames["tcp_in_flange_from"], "nominal");
  const Ran text = runProgram("frames '" + folder.string() + "'", scratch.path());
  EXPECT_EQ(text.status, 1);
  EXPECT_NE(
      text.err.find(
          "no frame is measured: R0 needs sweeps of axes 1 and 2 (`circle_sweeps`): the campaign has no circle sweeps"),
      std::string::npos)
      << text.err;
  EXPECT_NE(text.out.find("mm in the flange (nominal)"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("1-2"), std::string::npos);
}

}  // namespace report_test
}  // namespace stiffscope
