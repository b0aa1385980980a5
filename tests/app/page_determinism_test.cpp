#include <gtest/gtest.h>

#include <map>

#include "tests/app/command.h"

namespace stiffscope {
namespace page_determinism_test {

std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[entry.path().lexically_relative(folder).string()] = contentsOf(entry.path());
  }
  return files;
}

TEST(PageTwice, TheSameCampaignGivesTheSameBytes) {
  const ScratchFolder scratch;
  const std::filesystem::path sample = STIFFSCOPE_SOURCE_DIR "/samples/active";
  const auto elsewhere = scratch.path() / "another name";
  std::filesystem::copy(sample, elsewhere, std::filesystem::copy_options::recursive);
  ASSERT_EQ(
      runProgram("report '" + sample.string() + "' --out '" + (scratch.path() / "a").string() + "'", scratch.path())
          .status,
      0);
  ASSERT_EQ(
      runProgram("report '" + elsewhere.string() + "' --out '" + (scratch.path() / "b").string() + "'", scratch.path())
          .status,
      0);
  const auto first = filesIn(scratch.path() / "a"), second = filesIn(scratch.path() / "b");
  EXPECT_GT(first.size(), 20u);  // page, results, ten pictures, a dozen tables
  ASSERT_EQ(first.size(), second.size());
  for (const auto& [name, bytes] : first) {
    ASSERT_TRUE(second.contains(name)) << name;
    EXPECT_TRUE(second.at(name) == bytes) << name;
  }
  EXPECT_LT(first.at("report.html").size(), 5'000'000u);
}

}  // namespace page_determinism_test
}  // namespace stiffscope
