#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/app/command.h"

namespace stiffscope {
namespace bad_input_test {

namespace fs = std::filesystem;

void replaceOnce(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = contentsOf(file);
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no " << from;
  text.replace(at, from.size(), to);
  std::ofstream(file, std::ios::binary) << text;
}

struct Spoilt {
  const char* name;
  std::function<void(const fs::path& campaign)> spoil;
  std::vector<std::string> said;  ///< what the one line must hold
};

std::vector<Spoilt> spoiltCampaigns() {
  return {
      {"malformed XML",
       [](const fs::path& c) { replaceOnce(c / "campaign.xml", "</campaign>", ""); },
       {"campaign.xml:"}},
      {"no XML at all", [](const fs::path& c) { std::ofstream(c / "campaign.xml") << "hello\n"; }, {"campaign.xml"}},
      {"missing table", [](const fs::path& c) { fs::remove(c / "loading.csv"); }, {"loading.csv"}},
      {"truncated last line",
       [](const fs::path& c) {
         const std::string text = contentsOf(c / "states.csv");
         std::ofstream(c / "states.csv", std::ios::binary) << text.substr(0, text.size() - 30);
       },
       {"states.csv:96:"}},
      {"NaN",
       [](const fs::path& c) {
         std::string text = contentsOf(c / "loading.csv");
         const auto end = text.find('\n', text.find('\n') + 1);
         const auto cell = text.rfind(',', end) + 1;
         text.replace(cell, end - cell, "nan");
         std::ofstream(c / "loading.csv", std::ios::binary) << text;
       },
       {"loading.csv:2:", "z_mm", "'nan'"}},
      {"duplicate key",
       [](const fs::path& c) {
         const std::string text = contentsOf(c / "states.csv");
         const auto second = text.find('\n') + 1;
         std::ofstream(c / "states.csv", std::ios::binary)
             << text << text.substr(second, text.find('\n', second) + 1 - second);
       },
       {"states.csv:97:", "pose, step", "line 2"}},
      {"unknown target",
       [](const fs::path& c) { replaceOnce(c / "loading.csv", ",P11,", ",P13,"); },
       {"loading.csv:", "target", "'P13'"}},
      {"forces in the columns of angles",
       [](const fs::path& c) {
         replaceOnce(c / "states.csv", "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n",
                     "fx_n,fy_n,fz_n,q4_deg,q5_deg,q6_deg,q1_deg,q2_deg,q3_deg");
       },
       {"states.csv:", "q"}},
  };
}

TEST(BadInput, StatusTwoOneLineAndNothingLeftBehind) {
  for (const Spoilt& spoilt : spoiltCampaigns()) {
    SCOPED_TRACE(spoilt.name);
    const ScratchFolder scratch;
    const fs::path campaign = scratch.path() / "campaign";
    fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
    spoilt.spoil(campaign);
    for (const std::string& words :
         {"identify '" + campaign.string() + "' --json '" + (scratch.path() / "result.json").string() + "'",
          "report '" + campaign.string() + "' --out '" + (scratch.path() / "report").string() + "'"}) {
      const Ran ran = runProgram(words, scratch.path());
      EXPECT_EQ(ran.status, 2);
      EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
      for (const std::string& word : spoilt.said) EXPECT_NE(ran.err.find(word), std::string::npos) << ran.err;
      EXPECT_TRUE(ran.out.empty()) << ran.out;
    }
    EXPECT_FALSE(fs::exists(scratch.path() / "result.json"));
    EXPECT_FALSE(fs::exists(scratch.path() / "report"));
  }
}

TEST(BadInput, AFullStandardOutputIsNoSuccess) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const ScratchFolder scratch;
  const std::string samples = STIFFSCOPE_SOURCE_DIR "/samples", folder = scratch.path().string();
  for (const std::string& words :
       {"frames '" + samples + "/active'", "init '" + samples + "/m900ib700.urdf' --out '" + folder + "/new'",
        "import template --maker kuka '" + folder + "/day'"}) {
    const std::string line = "'" STIFFSCOPE_BINARY "' " + words + " >/dev/full 2>'" + folder + "/stderr'";
    const int raw = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(raw), 2) << words;
    EXPECT_EQ(contentsOf(scratch.path() / "stderr"),
              "stiffscope: standard output: cannot be written: No space left on device\n")
        << words;
  }
}

// A limit on the size of files stands for a full disk. The pictures of a report are larger.
TEST(BadInput, AReportThatDoesNotFitLeavesTheEarlierOne) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "report";
  const std::string words = " report '" STIFFSCOPE_SOURCE_DIR "/samples/inactive' --out '" + out.string() + "'";
  ASSERT_EQ(runProgram(words, scratch.path()).status, 0);
  const std::string page = contentsOf(out / "report.html"), results = contentsOf(out / "results.json");
  const std::string line = "ulimit -f 8; env -u DISPLAY '" STIFFSCOPE_BINARY "'" + words +
                           " --neglect-kc >/dev/null 2>'" + (scratch.path() / "stderr").string() + "'";
  const int raw = std::system(line.c_str());
  EXPECT_EQ(WEXITSTATUS(raw), 2);
  const std::string said = contentsOf(scratch.path() / "stderr");
  EXPECT_NE(said.find("cannot be written: File too large"), std::string::npos) << said;
  EXPECT_TRUE(contentsOf(out / "report.html") == page && contentsOf(out / "results.json") == results);
}

TEST(BadInput, NamesOutOfAFileCommandNoTerminal) {
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "campaign";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
  replaceOnce(campaign / "campaign.xml", "name=\"", "name=\"&#27;[31m");
  const Ran ran = runProgram("identify '" + campaign.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out.find('\x1b'), std::string::npos);
  EXPECT_NE(ran.out.find("?[31m"), std::string::npos);
}

TEST(BadInput, NoAuditPassesADayThatNothingCanBeIdentifiedFrom) {
  const auto never_unloaded = [](const fs::path& c) {
    for (const char* const table : {"states.csv", "loading.csv"}) {
      std::istringstream rows(contentsOf(c / table));
      std::ofstream kept(c / table);
      for (std::string row; std::getline(rows, row);) {
        if (row.find(",0,") != row.find(',')) kept << row << '\n';  // the step comes second
      }
    }
  };
  const auto without_cell = [](const fs::path& c) { replaceOnce(c / "campaign.xml", "<load_cell", "<load_sell"); };
  for (const auto& spoil :
       {std::function<void(const fs::path&)>(never_unloaded), std::function<void(const fs::path&)>(without_cell)}) {
    const ScratchFolder scratch;
    const fs::path campaign = scratch.path() / "campaign";
    fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
    spoil(campaign);
    const Ran ran = runProgram("audit '" + campaign.string() + "'", scratch.path());
    EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
    EXPECT_NE(ran.out.find("fail: not fit to identify from"), std::string::npos) << ran.out;
  }
}

TEST(BadInput, AnUnreadableFileIsNamed) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything: permissions cannot be tested as root";
  const ScratchFolder scratch;
  const fs::path campaign = scratch.path() / "campaign";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", campaign);
  fs::permissions(campaign / "campaign.xml", fs::perms::none);
  const Ran ran = runProgram("identify '" + campaign.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("campaign.xml"), std::string::npos) << ran.err;
}

}  // namespace bad_input_test
}  // namespace stiffscope
