#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/command.h"

// The output that README shows is the program's.

namespace stiffscope {
namespace readme_test {

const std::string kCommand = "$ build/bin/stiffscope ";

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Shown {
  std::string words;               ///< of the command
  std::vector<std::string> lines;  ///< of its output; "..." where some are left out
};

/// Of all `console` blocks.
std::vector<Shown> shownIn(const std::string& document) {
  std::vector<Shown> all;
  bool console = false;
  for (const std::string& line : linesOf(document)) {
    if (line.starts_with("```")) {
      console = line == "```console";
    } else if (console && line.starts_with(kCommand)) {
      all.push_back({line.substr(kCommand.size()), {}});
    } else if (console && !all.empty() && !line.starts_with("$ ")) {
      all.back().lines.push_back(line);
    }
  }
  return all;
}

/// Words alike, numbers within the last digits that another compiler may change; of an uncertainty, which draws are
/// made for, a tenth.
bool alike(const std::string& shown, const std::string& printed) {
  std::istringstream a(shown), b(printed);
  std::string one, other;
  const auto numberOf = [](std::string word) {
    if (word.starts_with("+-")) word.erase(0, 2);
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    return end != word.c_str() ? value : std::nan("");
  };
  while (a >> one) {
    if (!(b >> other)) return false;
    const double expected = numberOf(one), found = numberOf(other);
    const double tolerance = one.starts_with("+-") ? 0.1 : 2e-3;
    const bool same =
        std::isnan(expected) ? one == other : std::abs(expected - found) <= tolerance * std::abs(expected) + 1e-9;
    if (!same) return false;
  }
  return !(b >> other);
}

TEST(Readme, ShowsWhatTheProgramPrints) {
  const ScratchFolder scratch;
  const std::vector<Shown> all = shownIn(contentsOf(STIFFSCOPE_SOURCE_DIR "/README.md"));
  ASSERT_FALSE(all.empty());
  for (const Shown& one : all) {
    std::string words = one.words;
    const std::size_t at = words.find("samples/");
    if (at != std::string::npos) words.insert(at, STIFFSCOPE_SOURCE_DIR "/");
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 0) << ran.err;
    const std::vector<std::string> printed = linesOf(ran.out);
    std::size_t next = 0;
    bool gap = false;
    for (const std::string& line : one.lines) {
      if (line == "...") {
        gap = true;
        continue;
      }
      std::size_t found = next;
      while (gap && found < printed.size() && !alike(line, printed[found])) ++found;
      ASSERT_LT(found, printed.size()) << one.words << ": " << line;
      EXPECT_TRUE(alike(line, printed[found])) << one.words << ": " << line << "\nis: " << printed[found];
      next = found + 1;
      gap = false;
    }
  }
}

/// The first example of a document whose commands stand in a block of their own, as a shell runs it.
TEST(Compensation, ItsExampleIsWhatTheProgramPrints) {
  const ScratchFolder scratch;
  std::filesystem::create_directory_symlink(STIFFSCOPE_SOURCE_DIR "/samples", scratch.path() / "samples");
  std::string script =
      "stiffscope() { env -u DISPLAY '" STIFFSCOPE_BINARY "' \"$@\"; }\ncd '" + scratch.path().string() + "'\n";
  std::vector<std::string> shown;
  bool console = false, command = false;
  for (const std::string& line : linesOf(contentsOf(STIFFSCOPE_SOURCE_DIR "/docs/compensation.md"))) {
    if (line.starts_with("```")) {
      if (console) break;
      console = line == "```console";
    } else if (console && (command || line.starts_with("$ "))) {
      script += (command ? line : line.substr(2)) + "\n";
      command = line.ends_with('\\');
    } else if (console && line != "...") {
      shown.push_back(line);
    }
  }
  ASSERT_GT(shown.size(), 8u);
  std::ofstream(scratch.path() / "script") << script;
  const std::string out = (scratch.path() / "out").string();
  ASSERT_EQ(std::system(("bash '" + (scratch.path() / "script").string() + "' >'" + out + "'").c_str()), 0);
  const std::vector<std::string> printed = linesOf(contentsOf(out));
  ASSERT_GE(printed.size(), shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_TRUE(alike(shown[i], printed[i])) << printed[i];
}

}  // namespace readme_test
}  // namespace stiffscope
