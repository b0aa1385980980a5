#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/command.h"

// What the audit finds reaches the other commands, and --raw keeps it from them.

namespace stiffscope {
namespace preparation_test {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSample = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active";

/// The sample with the beam lost in one line of its loading.
fs::path lostBeamAt(int lost, const ScratchFolder& scratch) {
  const fs::path spoilt = scratch.path() / "spoilt";
  fs::copy(kSample, spoilt);
  std::istringstream lines(contentsOf(spoilt / "loading.csv"));
  std::ofstream out(spoilt / "loading.csv", std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == lost) {  // pose,step,repeat,target,time_s stay
      std::size_t comma = 0;
      for (int k = 0; k < 5; ++k) comma = line.find(',', comma) + 1;
      line = line.substr(0, comma) + "0.0000,0.0000,0.0000";
    }
    out << line << '\n';
  }
  return spoilt;
}

std::string quoted(const fs::path& path) { return " '" + path.string() + "' "; }

json jsonOf(const std::string& words, const ScratchFolder& scratch) {
  return json::parse(runProgram(words + " --json -", scratch.path()).out);
}

TEST(Preparation, RejectedReadingsAreLeftOutOfEveryCommand) {
  const ScratchFolder scratch;
  const fs::path spoilt = lostBeamAt(100, scratch);
  for (const std::string command : {"identify", "frames", "compensate"}) {
    SCOPED_TRACE(command);
    const json prepared = jsonOf(command + quoted(spoilt), scratch)["preparation"];
    EXPECT_EQ(prepared["raw"], false);
    ASSERT_EQ(prepared["rejected"].size(), 1u);
    EXPECT_EQ(prepared["rejected"][0]["file"], "loading.csv");
    EXPECT_EQ(prepared["rejected"][0]["line"], 100);
    EXPECT_EQ(prepared["drift"]["taken_off"], false);
    EXPECT_FALSE(prepared["drift"]["reason"].get<std::string>().empty());
    const Ran text = runProgram(command + quoted(spoilt), scratch.path());
    EXPECT_NE(text.out.find("loading.csv:100: lost beam"), std::string::npos) << text.out;
  }
}

TEST(Preparation, RawKeepsEverythingAndSaysSo) {
  const ScratchFolder scratch;
  const fs::path spoilt = lostBeamAt(100, scratch);
  const json raw = jsonOf("identify --raw" + quoted(spoilt), scratch);
  const json clean = jsonOf("identify" + quoted(spoilt), scratch);
  EXPECT_EQ(raw["preparation"]["raw"], true);
  EXPECT_TRUE(raw["preparation"]["rejected"].empty());
  // One of three repeats at the station, metres off: it ruins its posture.
  EXPECT_GT(raw["methods"]["pp"]["rms_residual_mm"].get<double>(),
            10.0 * clean["methods"]["pp"]["rms_residual_mm"].get<double>());
  const Ran text = runProgram("identify --raw" + quoted(spoilt), scratch.path());
  EXPECT_NE(text.out.find("Readings: raw: nothing left out, no drift taken off."), std::string::npos) << text.out;
}

TEST(Preparation, EveryCommandHasRawAndTheNearestNameOfIt) {
  const ScratchFolder scratch;
  for (const std::string command : {"identify", "frames", "compensate", "report"}) {
    SCOPED_TRACE(command);
    EXPECT_NE(runProgram(command + " --help", scratch.path()).out.find("--raw"), std::string::npos);
    const Ran wrong = runProgram(command + quoted(kSample) + "--rav", scratch.path());
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("did you mean '--raw'?"), std::string::npos) << wrong.err;
  }
}

TEST(Preparation, AnUnknownStepListsThoseThereAre) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("identify --step 9" + quoted(kSample), scratch.path());
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("'9': not a load step of this campaign, which has 1, 2, 3, 4"), std::string::npos) << ran.err;
}

}  // namespace preparation_test
}  // namespace stiffscope
