#include <gtest/gtest.h>

#include "tests/app/command.h"

namespace stiffscope {
namespace kept_inputs_test {

namespace fs = std::filesystem;

// What was measured, or written by a person, is never written over.
class KeptInputs : public ::testing::Test {
 protected:
  KeptInputs() { fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign_); }

  /// Runs `words`, which must be refused with `said`, and `file` must stay.
  void refused(const std::string& words, const fs::path& file, const std::string& said) const {
    const std::string before = contentsOf(file);
    const Ran ran = runProgram(words, scratch_.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
    EXPECT_TRUE(contentsOf(file) == before) << words;
  }

  std::string quoted(const fs::path& path) const { return " '" + path.string() + "' "; }

  const ScratchFolder scratch_;
  const fs::path campaign_ = scratch_.path() / "campaign";
};

TEST_F(KeptInputs, JsonOntoAnyFileOfTheCampaign) {
  for (const char* const file : {"states.csv", "loading.csv", "circle_sweeps.csv", "robot.urdf", "campaign.xml"}) {
    refused("frames" + quoted(campaign_) + "--json" + quoted(campaign_ / file), campaign_ / file,
            "it is an input of this run");
  }
  const fs::path link = scratch_.path() / "link.json";
  fs::create_symlink(campaign_ / "states.csv", link);
  refused("frames" + quoted(campaign_) + "--json" + quoted(link), campaign_ / "states.csv",
          "it is an input of this run");
}

TEST_F(KeptInputs, PointsAndPostures) {
  const fs::path points = scratch_.path() / "points.txt";
  std::ofstream(points) << "0 0 0\n1 0 0\n0 1 0\n1 1 0.01\n";
  refused("fit plane" + quoted(points) + "--json" + quoted(points), points, "it is an input of this run");
  refused("plan" + quoted(campaign_) + "--candidates 50 --out" + quoted(campaign_ / "states.csv"),
          campaign_ / "states.csv", "it is an input of this run");
}

TEST_F(KeptInputs, FilesOfACalibrationAreLookedAtBeforeItIsComputed) {
  for (const char* const option : {"--csv", "--urdf"}) {
    const fs::path file = campaign_ / "robot.urdf";
    refused("calibrate" + quoted(campaign_) + option + quoted(file), file, "it is an input of this run");
    EXPECT_EQ(contentsOf(scratch_.path() / "stdout"), "") << option;
  }
}

TEST_F(KeptInputs, TwoResultsInOneFile) {
  const fs::path file = scratch_.path() / "plan.csv";
  const Ran ran = runProgram(
      "plan" + quoted(campaign_) + "--candidates 50 --out" + quoted(file) + "--json" + quoted(file), scratch_.path());
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("expected another file for --json than for --out"), std::string::npos) << ran.err;
}

TEST_F(KeptInputs, AReportGoesIntoNoCampaignAndOverNoFileOfTheUser) {
  refused("report" + quoted(campaign_) + "--out" + quoted(campaign_), campaign_ / "campaign.xml",
          "it holds a campaign");
  const fs::path out = scratch_.path() / "out";
  fs::create_directory(out);
  std::ofstream(out / "stiffness.csv") << "mine\n";
  refused("report" + quoted(campaign_) + "--out" + quoted(out), out / "stiffness.csv",
          "stiffness.csv: not written: it is there and of no earlier report");
  EXPECT_FALSE(fs::exists(out / "report.html"));
  fs::remove(out / "stiffness.csv");
  for (int run = 0; run < 2; ++run)
    EXPECT_EQ(runProgram("report" + quoted(campaign_) + "--out" + quoted(out), scratch_.path()).status, 0);
}

TEST_F(KeptInputs, ASimulationReplacesACampaignWhereAskedTo) {
  const std::string words = "simulate '" STIFFSCOPE_SOURCE_DIR "/samples/inactive.xml' --out" + quoted(campaign_);
  refused(words, campaign_ / "campaign.xml", "it holds a campaign; expected another folder, or --replace");
  // Neither does it write over tables that stand there alone.
  const fs::path mine = scratch_.path() / "mine";
  fs::create_directory(mine);
  std::ofstream(mine / "states.csv") << "mine\n";
  refused("simulate '" STIFFSCOPE_SOURCE_DIR "/samples/inactive.xml' --out" + quoted(mine), mine / "states.csv",
          "states.csv: not written: it is there; expected another folder, or --replace");
  EXPECT_FALSE(fs::exists(mine / "campaign.xml"));
  const std::string before = contentsOf(campaign_ / "campaign.xml");
  EXPECT_EQ(runProgram(words + "--replace", scratch_.path()).status, 0);
  EXPECT_FALSE(contentsOf(campaign_ / "campaign.xml") == before);
}

}  // namespace kept_inputs_test
}  // namespace stiffscope
