#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/numerics/parallel.h"
#include "tests/app/command.h"

// Ways to misuse the program, one a line of attacks.txt: what a shell sets up in a folder, the command, its status, and
// words of its message. Of all of them: none hangs or dies of a signal; what is refused leaves every file as it was and
// no new one, and says why in one line; what is done leaves every file that was there.

namespace stiffscope {
namespace attacks_test {

namespace fs = std::filesystem;

struct Attack {
  std::size_t line = 0;
  std::string kind, setup, command, said;
  int status = 0;
};

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == '\t')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::vector<Attack> attacks() {
  std::ifstream file(STIFFSCOPE_SOURCE_DIR "/tests/app/attacks.txt");
  std::vector<Attack> all;
  std::string kind;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line.starts_with("//")) continue;
    if (line.starts_with("# ")) {
      kind = line.substr(2);
      continue;
    }
    const std::vector<std::string> cells = cellsOf(line);
    if (cells.size() != 4) throw std::runtime_error(fmt::format("attacks.txt:{}: expected four cells", number));
    all.push_back({number, kind, cells[1], cells[2], cells[3], std::stoi(cells[0])});
  }
  return all;
}

/// All files below a folder, by name: their bytes, where a link leads, or that they are something else.
std::map<std::string, std::string> filesIn(const fs::path& folder) {
  constexpr std::uintmax_t kLarge = 30'000'000;  // of which the size is enough
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_symlink())
      files[name] = "link to " + fs::read_symlink(entry.path()).string();
    else if (entry.is_regular_file())
      files[name] = entry.file_size() > kLarge ? std::to_string(entry.file_size()) : contentsOf(entry.path());
    else
      files[name] = "no file";
  }
  return files;
}

/// The program is called stiffscope there.
int runScript(const std::string& script, const fs::path& scratch) {
  std::ofstream(scratch / "script") << "stiffscope() { timeout 300 env -u DISPLAY '" STIFFSCOPE_BINARY
                                       "' \"$@\"; }\ncd '"
                                    << (scratch / "attack").string() << "'\n"
                                    << script << '\n';
  const std::string line = "bash '" + (scratch / "script").string() + "' </dev/null >'" + (scratch / "out").string() +
                           "' 2>'" + (scratch / "err").string() + "'";
  const int raw = std::system(line.c_str());
  return WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
}

/// What went otherwise than it should; empty where nothing did.
std::string wrongOf(const Attack& attack) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "attack", samples = fs::path(STIFFSCOPE_SOURCE_DIR) / "samples";
  fs::create_directory(folder);
  fs::copy(samples / "active", folder / "day");
  fs::copy(samples / "unloaded", folder / "unloaded");
  fs::copy(samples / "active.xml", folder / "spec.xml");
  fs::copy(samples / "m900ib700.urdf", folder / "m900ib700.urdf");
  std::ofstream(folder / "p.txt") << "0 0 0\n1 0 0\n0 1 0\n1 1 0.01\n";
  if (!attack.setup.empty() && runScript(attack.setup, scratch.path()) != 0)
    return "not set up: " + contentsOf(scratch.path() / "err");
  const auto before = filesIn(folder);
  const int status = runScript("set -o pipefail\n" + attack.command, scratch.path());
  const std::string err = contentsOf(scratch.path() / "err");
  std::string wrong;
  if (status != attack.status) wrong += fmt::format("status {} for {}\n", status, attack.status);
  if (err.find(attack.said) == std::string::npos) wrong += "not said: " + attack.said + "\n";
  if (status == 2) {
    std::istringstream lines(err);
    int said = 0;
    for (std::string line; std::getline(lines, line);) said += line.starts_with("stiffscope: warning:") ? 0 : 1;
    if (said > 1) wrong += "more than one line\n";
  }
  const auto after = filesIn(folder);
  for (const auto& [name, bytes] : before) {
    const auto still = after.find(name);
    if (still == after.end() || still->second != bytes) wrong += name + " is no longer what it was\n";
  }
  for (const auto& [name, bytes] : after) {
    if (status == 2 && !before.contains(name)) wrong += name + " is new\n";
  }
  return wrong.empty() ? wrong : fmt::format("attacks.txt:{}: {}\n{}{}", attack.line, attack.command, wrong, err);
}

class Attacks : public ::testing::TestWithParam<std::string> {};

TEST_P(Attacks, AreAnsweredAndLeaveTheFiles) {
  std::vector<Attack> some = attacks();
  std::erase_if(some, [&](const Attack& attack) { return attack.kind != GetParam(); });
  ASSERT_FALSE(some.empty());
  std::vector<std::string> wrong(some.size());
  numerics::onAllCores(some.size(), [&](std::size_t i) { wrong[i] = wrongOf(some[i]); });
  for (const std::string& one : wrong) EXPECT_TRUE(one.empty()) << one;
}

const std::vector<std::string> kKinds{"Known",  "Outputs", "Options", "Xml",      "Urdf", "Tables",      "Points",
                                      "Fleets", "Results", "Limits",  "Postures", "Days", "Surroundings"};

INSTANTIATE_TEST_SUITE_P(OfAllKinds, Attacks, ::testing::ValuesIn(kKinds), [](const auto& one) { return one.param; });

TEST(AttacksTable, HasNoOtherKinds) {
  const std::set<std::string> known(kKinds.begin(), kKinds.end());
  for (const Attack& attack : attacks()) EXPECT_TRUE(known.contains(attack.kind)) << attack.kind;
}

}  // namespace attacks_test
}  // namespace stiffscope
