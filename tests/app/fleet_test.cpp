#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>

#include "tests/app/command.h"

namespace stiffscope {
namespace fleet_command_test {

namespace fs = std::filesystem;

const std::vector<std::string> kResults{"fleet.csv",      "fleet.jsonl", "changes.csv", "steps.csv",
                                        "detectable.csv", "needs.csv",   "fleet.html"};

/// A small day of the sample's machine.
void simulateDay(const fs::path& scratch, const fs::path& folder, int machine, int measurement) {
  std::string spec = contentsOf(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  const std::pair<const char*, std::string> changes[] = {
      {"urdf=\"", "urdf=\"" STIFFSCOPE_SOURCE_DIR "/samples/"},
      {"seed=\"20170924\" measurement=\"2\"", fmt::format("seed=\"{}\" measurement=\"{}\"", machine, measurement)},
      {"count=\"19\"", "count=\"8\""},
      {"count=\"20\"", "count=\"8\""},
      {"repeats=\"3\"", "repeats=\"2\""},
      {"readings=\"1000\"", "readings=\"60\""},
      {"date=\"2026-11-21\"", fmt::format("date=\"2026-01-1{}\"", measurement)}};
  for (const auto& [from, to] : changes) spec = std::regex_replace(spec, std::regex(from), to);
  std::ofstream(scratch / "spec.xml") << spec;
  const Ran ran =
      runProgram(fmt::format("simulate '{}' --out '{}'", (scratch / "spec.xml").string(), folder.string()), scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
}

class FleetCommand : public testing::Test {
 protected:
  ScratchFolder scratch;
  fs::path fleet = scratch.path() / "fleet";

  void SetUp() override {
    for (int day = 1; day <= 2; ++day)
      simulateDay(scratch.path(), fleet / "M1" / ("day" + std::to_string(day)), 1, day);
    fs::create_directories(fleet / "M2" / "broken");
    std::ofstream(fleet / "M2" / "broken" / "campaign.xml")
        << "<campaign format=\"1\" name=\"broken\" date=\"2026-01-11\"/>";
  }

  Ran run(const std::string& out, const std::string& options = {}) const {
    return runProgram(fmt::format("fleet '{}' --out '{}' --springs-only {}", fleet.string(),
                                  (scratch.path() / out).string(), options),
                      scratch.path());
  }

  std::map<std::string, std::string> results(const std::string& out) const {
    std::map<std::string, std::string> bytes;
    for (const std::string& file : kResults) bytes[file] = contentsOf(scratch.path() / out / file);
    return bytes;
  }
};

TEST_F(FleetCommand, IsBegunAgainAndSharedAndMergedToTheSameBytes) {
  const Ran whole = run("whole");
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_NE(whole.out.find("2 machines, 3 campaigns, 1 without a result\n"), std::string::npos) << whole.out;
  EXPECT_NE(whole.out.find("M2               no result"), std::string::npos) << whole.out;
  const auto expected = results("whole");
  EXPECT_NE(expected.at("fleet.csv").find("M2,2026-01-11,"), std::string::npos);
  EXPECT_NE(expected.at("fleet.csv").find("campaign.xml"), std::string::npos);  // the failure's text
  EXPECT_NE(expected.at("fleet.html").find("data:image/png;base64,"), std::string::npos);
  EXPECT_NE(expected.at("changes.csv").find("M1,2026-01-11,2026-01-12,compliance,2,"), std::string::npos);

  // As after a kill: one result missing, pages gone. What is there is not done again.
  std::map<fs::path, fs::file_time_type> kept;
  for (const auto& entry : fs::directory_iterator(scratch.path() / "whole" / "campaigns"))
    kept[entry.path()] = entry.last_write_time();
  ASSERT_EQ(kept.size(), 3u);
  fs::remove(kept.begin()->first);
  fs::remove(scratch.path() / "whole" / "fleet.html");
  ASSERT_EQ(run("whole").status, 0);
  EXPECT_EQ(results("whole"), expected);
  for (auto one = std::next(kept.begin()); one != kept.end(); ++one)
    EXPECT_EQ(fs::last_write_time(one->first), one->second) << one->first;

  // By two that share, in any order; before the second there is nothing to merge.
  EXPECT_EQ(run("shared", "--shard 2/2").status, 0);
  EXPECT_FALSE(fs::exists(scratch.path() / "shared" / "fleet.csv"));
  const Ran early = run("shared", "--merge");
  EXPECT_EQ(early.status, 2);
  EXPECT_NE(early.err.find("2 of 3 campaigns have no result yet"), std::string::npos) << early.err;
  EXPECT_EQ(run("shared", "--shard 1/2 --jobs 1").status, 0);
  EXPECT_EQ(run("shared", "--merge").status, 0);
  EXPECT_EQ(results("shared"), expected);
}

// A process that is killed costs its row, and is begun again by the next run.
TEST_F(FleetCommand, ACrashCostsItsRow) {
  const Ran first = runProgram(fmt::format("fleet '{}' --out '{}' --springs-only --jobs 1", (fleet / "M1").string(),
                                           (scratch.path() / "out").string()),
                               scratch.path());
  ASSERT_EQ(first.status, 0) << first.err;
  // The message of a process that ended without a result stands in the place of one.
  const fs::path folder = scratch.path() / "out" / "campaigns";
  const fs::path result = fs::directory_iterator(folder)->path();
  fs::remove(result);
  fs::path message = result;
  std::ofstream(message.replace_extension(".failed")) << "ended by signal 9, Killed";
  const std::string merge = fmt::format("fleet '{}' --out '{}' --springs-only --merge", (fleet / "M1").string(),
                                        (scratch.path() / "out").string());
  ASSERT_EQ(runProgram(merge, scratch.path()).status, 0);
  EXPECT_NE(contentsOf(scratch.path() / "out" / "fleet.csv").find("\"ended by signal 9, Killed\""), std::string::npos);
  ASSERT_EQ(runProgram(merge.substr(0, merge.find(" --merge")), scratch.path()).status, 0);
  EXPECT_FALSE(fs::exists(message));
  EXPECT_EQ(contentsOf(scratch.path() / "out" / "fleet.csv").find("signal"), std::string::npos);
  // So is a report's, whose campaign has a result; one of which nothing is known is missing all the same.
  const fs::path report = scratch.path() / "out" / "reports" / result.stem();
  fs::create_directories(report);
  std::ofstream(report / "report.failed") << "ended by signal 9, Killed";
  const Ran reports = runProgram(merge + " --reports", scratch.path());
  ASSERT_EQ(reports.status, 0) << reports.err;
  EXPECT_NE(reports.out.find("2 reports not written (report_failure in fleet.csv): "), std::string::npos)
      << reports.out;
  const std::string rows = contentsOf(scratch.path() / "out" / "fleet.csv");
  EXPECT_NE(rows.find(",\"ended by signal 9, Killed\""), std::string::npos) << rows;
  EXPECT_NE(rows.find(",not written yet"), std::string::npos) << rows;
  EXPECT_NE(contentsOf(scratch.path() / "out" / "fleet.jsonl").find("\"report_failure\":\"ended by signal 9, Killed\""),
            std::string::npos);
}

// What cannot be read as text has no head to be told apart by.
TEST(FleetFolders, WithoutAReadableCampaignHaveEachItsOwnMessage) {
  const ScratchFolder scratch;
  for (const char* folder : {"A/d1", "B/d1"}) fs::create_directories(scratch.path() / "fleet" / folder);
  std::ofstream(scratch.path() / "fleet/A/d1/campaign.xml", std::ios::binary) << std::string("\xff\xfe<\0c\0", 6);
  std::ofstream(scratch.path() / "fleet/B/d1/campaign.xml", std::ios::binary).flush();
  const Ran ran = runProgram(
      fmt::format("fleet '{}' --out '{}'", (scratch.path() / "fleet").string(), (scratch.path() / "out").string()),
      scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path() / "out" / "campaigns"), {}), 2);
  const std::string rows = contentsOf(scratch.path() / "out" / "fleet.csv");
  const std::size_t second = rows.find("\nB,");
  ASSERT_NE(second, std::string::npos) << rows;
  EXPECT_LT(rows.find("UTF-16"), second) << rows;
  EXPECT_EQ(rows.find("UTF-16", second), std::string::npos) << rows;
}

/// The working directory of a test, and the old one after it.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) { fs::current_path(folder); }
  ~WorkingFolder() { fs::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  fs::path before_;
};

// Of the fleet's own processes and of SLURM's jobs no folder is taken for an option.
TEST(FleetFolders, MayBeginWithADash) {
  const ScratchFolder scratch;
  simulateDay(scratch.path(), scratch.path() / "-lab2" / "d1", 1, 1);
  const WorkingFolder here(scratch.path());
  const Ran ran = runProgram("fleet ./-lab2 --out=-out --springs-only --reports", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("1 machines, 1 campaigns, 0 without a result\n"), std::string::npos) << ran.out;
  const std::string table = contentsOf(scratch.path() / "-out" / "fleet.csv");
  EXPECT_NE(table.find("-lab2/d1,,loaded,"), std::string::npos) << table;
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path() / "-out" / "reports"), {}), 1);
  for (const auto& report : fs::directory_iterator(scratch.path() / "-out" / "reports"))
    EXPECT_TRUE(fs::exists(report.path() / "report.html")) << report.path();
  const Ran dry = runProgram("fleet --out=-out --slurm 2 --slurm-dry-run -- -lab2", scratch.path());
  ASSERT_EQ(dry.status, 0) << dry.err;
  const std::string merge = contentsOf(scratch.path() / "-out" / "slurm" / "merge.sh");
  EXPECT_NE(merge.find(" fleet ./-lab2 --out ./-out --merge\n"), std::string::npos) << merge;
}

/// A day without a load of the sample's machine, or of another URDF, in the same 40 postures, joint 2 of this
/// stiffness.
void simulateUnloadedDay(const fs::path& scratch, const fs::path& folder, int measurement, const char* stiffness,
                         const std::string& urdf = STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf") {
  std::string spec = contentsOf(STIFFSCOPE_SOURCE_DIR "/samples/unloaded.xml");
  const std::pair<const char*, std::string> changes[] = {
      {"urdf=\"[^\"]*", "urdf=\"" + urdf},
      {"seed=\"20261123\"", fmt::format("seed=\"7\" measurement=\"{}\"", measurement)},
      {"count=\"100\"", "count=\"40\""},
      {"stiffness_nm_per_rad=\"5.6e6\"", fmt::format("stiffness_nm_per_rad=\"{}\"", stiffness)},
      {"date=\"2026-11-23\"", fmt::format("date=\"2026-01-1{}\"", measurement)}};
  for (const auto& [from, to] : changes) spec = std::regex_replace(spec, std::regex(from), to);
  std::ofstream(scratch / "spec.xml") << spec;
  const Ran ran =
      runProgram(fmt::format("simulate '{}' --out '{}'", (scratch / "spec.xml").string(), folder.string()), scratch);
  ASSERT_EQ(ran.status, 0) << ran.err;
}

// Four days, joint 2 softer by 6 % (compliance by 6.4 %) from the third on: that joint, that date and nothing else.
TEST(FleetOfDaysWithoutALoad, AJointThatSoftensIsFound) {
  const ScratchFolder scratch;
  const fs::path fleet = scratch.path() / "fleet", out = scratch.path() / "out";
  for (int day = 1; day <= 4; ++day)
    simulateUnloadedDay(scratch.path(), fleet / "M1" / ("day" + std::to_string(day)), day,
                        day < 3 ? "5.6e6" : "5.264e6");
  const Ran ran = runProgram(fmt::format("fleet '{}' --out '{}'", fleet.string(), out.string()), scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string steps = contentsOf(out / "steps.csv");
  EXPECT_EQ(std::count(steps.begin(), steps.end(), '\n'), 2) << steps;
  EXPECT_NE(steps.find("M1,2026-01-13,compliance,2,,0.06"), std::string::npos) << steps;
  EXPECT_NE(ran.out.find("joint 2 softer from 2026-01-13 on"), std::string::npos) << ran.out;
  // Joint 1 stands upright: its row says that nothing is told of it.
  EXPECT_NE(contentsOf(out / "detectable.csv").find("M1,unloaded,unspecified,1,4,yes,,,"), std::string::npos);
  EXPECT_NE(contentsOf(out / "changes.csv").find("2026-01-12,2026-01-13,compliance,2,"), std::string::npos);
  EXPECT_NE(contentsOf(out / "changes.csv").find("2026-01-12,2026-01-13,geometry,"), std::string::npos);
}

// Machines of two sizes, their days in one folder without a serial: nothing of one is held against the other, one row
// says so, and shards come to the same bytes.
TEST(FleetOfDaysWithoutALoad, DifferentMachinesUnderOneNameAreNotCompared) {
  const ScratchFolder scratch;
  const fs::path lab = scratch.path() / "lab", longer = scratch.path() / "longer.urdf";
  std::ofstream(longer) << std::regex_replace(contentsOf(STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf"),
                                              std::regex("xyz=\"0.41 0 0\""), "xyz=\"0.61 0 0\"");
  simulateUnloadedDay(scratch.path(), lab / "day1", 1, "5.6e6");
  simulateUnloadedDay(scratch.path(), lab / "day2", 2, "2.8e6", longer.string());
  const auto run = [&](const char* out, const char* options) {
    return runProgram(fmt::format("fleet '{}' --out '{}' {}", lab.string(), (scratch.path() / out).string(), options),
                      scratch.path());
  };
  const Ran ran = run("out", "");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("lab              several machines 2 machines under one name"), std::string::npos) << ran.out;
  const fs::path out = scratch.path() / "out";
  for (const char* table : {"steps.csv", "changes.csv"}) {
    const std::string rows = contentsOf(out / table);
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1) << rows;
  }
  const std::string needs = contentsOf(out / "needs.csv");
  EXPECT_NE(needs.find("1,lab,several_machines,2026-01-12,"), std::string::npos) << needs;
  EXPECT_NE(needs.find("axis 2 stands 200.0 mm elsewhere"), std::string::npos) << needs;
  EXPECT_NE(contentsOf(out / "fleet.html").find("axis 2 stands 200.0 mm elsewhere"), std::string::npos);
  for (const char* options : {"--shard 2/2", "--shard 1/2 --jobs 1", "--merge"})
    EXPECT_EQ(run("shared", options).status, 0) << options;
  for (const std::string& file : kResults)
    EXPECT_EQ(contentsOf(scratch.path() / "shared" / file), contentsOf(out / file)) << file;
}

TEST(FleetOptions, AreRefusedByTheirNames) {
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "out").string();
  fs::create_directories(scratch.path() / "empty");
  const auto refused = [&](const std::string& words, const std::string& said) {
    const Ran ran = runProgram(words + " --out '" + out + "'", scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
    EXPECT_FALSE(fs::exists(out)) << words;
  };
  const std::string sample = "fleet '" STIFFSCOPE_SOURCE_DIR "/samples'";
  refused("fleet '" + (scratch.path() / "empty").string() + "'",
          "expected a campaign.xml in it or below it; there is none");
  refused("fleet '" + (scratch.path() / "none").string() + "'", "expected a folder with campaigns");
  for (const char* shard : {"0/2", "3/2", "1", "a/b", "1/2/3", "-1/2"})
    refused(sample + " --shard=" + shard, "--shard: ");
  refused(sample + " --slurm 0", "--slurm");
  refused("blind --shard=5/4", "--shard: ");
}

TEST(Slurm, ADryRunWritesAnArrayAndAMerge) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "it's here";
  const Ran ran = runProgram(
      fmt::format("blind --cases 100 --slurm 4 --slurm-dry-run --sbatch=--mem=2G --out \"{}\"", out.string()),
      scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string array = contentsOf(out / "slurm" / "array.sh"), merge = contentsOf(out / "slurm" / "merge.sh");
  for (const char* part :
       {"#SBATCH --array=1-4\n", "#SBATCH --requeue\n", "#SBATCH --mem=2G\n", " blind --cases 100 --seed 1 --out '",
        "it'\\''s here' --as-is ", " --shard \"$SLURM_ARRAY_TASK_ID/4\" --threads \"${SLURM_CPUS_ON_NODE:-1}\"\n"})
    EXPECT_NE(array.find(part), std::string::npos) << part << "\n" << array;
  EXPECT_NE(merge.find(" --merge\n"), std::string::npos) << merge;
  EXPECT_EQ(std::system(fmt::format("sh -n \"{}\"", (out / "slurm" / "array.sh").string()).c_str()), 0);
}

}  // namespace fleet_command_test
}  // namespace stiffscope
