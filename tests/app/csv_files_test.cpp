// Every CSV that a report writes can be read by a program: units in the names, a number or nothing in a numeric cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <vector>

#include "core/io/numbers.h"
#include "tests/app/command.h"

namespace stiffscope {
namespace csv_files_test {

namespace fs = std::filesystem;

using Record = std::vector<std::string>;

/// Of RFC 4180, read by hand: the code under test has the writer only.
std::vector<Record> recordsOf(const std::string& bytes) {
  std::vector<Record> records(1);
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (quoted) {
      if (c == '"' && i + 1 < bytes.size() && bytes[i + 1] == '"') {
        field += bytes[++i];
      } else if (c == '"') {
        quoted = false;
      } else {
        field += c;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      records.back().push_back(std::move(field));
      field.clear();
      if (c == '\n') records.emplace_back();
    } else if (c != '\r') {
      field += c;
    }
  }
  records.pop_back();  // after the last line's end
  return records;
}

/// Tables of words by nature: names and sentences beside each other.
const std::set<std::string> kOfWords{"conditions", "inputs", "versions", "settings"};

/// Columns that hold names or sentences.
const std::set<std::string> kTexts{"method",    "mark",           "reason",
                                   "at",        "chosen_by",      "source",
                                   "effects",   "detail",         "by",
                                   "part",      "effect",         "parameter",
                                   "unit",      "check",          "verdict",
                                   "where",     "message",        "limit_by",
                                   "pose",      "reflector",      "model",
                                   "what",      "name",           "point",
                                   "place",     "unknown_joints", "held_under_load",
                                   "agreement", "Effect",         "Method",
                                   "Reflector", "Point",          "Axes",
                                   "Remark",    "series",         "category",
                                   "quantity"};

/// Numbers without a unit: counts, indices, ratios and components of unit vectors.
const std::set<std::string> kPure{"joint",
                                  "identifiable",
                                  "step",
                                  "shown_on_page",
                                  "in_verdict",
                                  "score",
                                  "value",
                                  "u",
                                  "limit",
                                  "parameters",
                                  "axis",
                                  "axis_from",
                                  "axis_to",
                                  "states",
                                  "used",
                                  "conditioning",
                                  "jacobian_condition",
                                  "p_value_holm",
                                  "Axis",
                                  "Circles",
                                  "Condition number",
                                  "Count",
                                  "near_parallel"};

bool hasUnit(const std::string& column) {
  static const std::regex kInName("_(nm_per_rad|rad_per_nm|n_per_um|percent|mdeg|deg|rad|mm|um|m|nm|sd|n)$");
  static const std::regex kInBrackets("\\((mm|µm|°)\\)$");
  static const std::regex kDirection("(^|_)(direction_|[uv]_)[xyz]$");
  return std::regex_search(column, kInName) || std::regex_search(column, kInBrackets) ||
         std::regex_search(column, kDirection);
}

bool isNumber(const std::string& cell) { return std::isfinite(io::numberOrNan(cell)); }

void expectReadable(const fs::path& file) {
  const std::string id = std::regex_replace(file.stem().string(), std::regex("-[0-9]+$"), "");
  if (kOfWords.contains(id)) return;
  const std::vector<Record> records = recordsOf(contentsOf(file));
  ASSERT_GT(records.size(), 1u) << file;
  const Record& header = records.front();
  EXPECT_EQ(std::set<std::string>(header.begin(), header.end()).size(), header.size()) << file << ": a name twice";
  for (std::size_t column = 0; column < header.size(); ++column) {
    const std::string& name = header[column];
    if (kTexts.contains(name)) continue;
    EXPECT_TRUE(hasUnit(name) || kPure.contains(name)) << file << ": " << name << " has no unit";
    for (std::size_t row = 1; row < records.size(); ++row) {
      ASSERT_EQ(records[row].size(), header.size()) << file << ", line " << row + 1;
      const std::string& cell = records[row][column];
      EXPECT_TRUE(cell.empty() || isNumber(cell)) << file << ", line " << row + 1 << ", " << name << ": " << cell;
    }
  }
}

void expectAllReadable(const fs::path& folder, const std::vector<std::string>& expected) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    names.insert(entry.path().stem().string());
    expectReadable(entry.path());
  }
  for (const std::string& name : expected) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(CsvFiles, OfALoadedDayAreReadByAProgram) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "report";
  const Ran ran = runProgram("report '" STIFFSCOPE_SOURCE_DIR "/samples/inactive' '" STIFFSCOPE_SOURCE_DIR
                             "/samples/active' --paper --out '" +
                                 out.string() + "'",
                             scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  expectAllReadable(out, {"axes-1", "postures-1", "posture-stiffness-2", "stiffness-slice-2", "stiffness-1",
                          "subsets-2", "taken-away", "budget-1", "gap-2", "audit-passed-1"});
  const std::vector<Record> axes = recordsOf(contentsOf(out / "axes-1.csv"));
  ASSERT_EQ(axes.size(), 7u);
  const auto at = [&axes](const char* name, std::size_t row) {
    const auto column = std::find(axes.front().begin(), axes.front().end(), name) - axes.front().begin();
    return io::numberOrNan(axes[row].at(static_cast<std::size_t>(column)));
  };
  // R0's z axis is axis 1 (campaign format).
  EXPECT_NEAR(at("direction_z", 1), 1.0, 1e-9);
  EXPECT_NEAR(at("direction_x", 1), 0.0, 1e-9);
  EXPECT_GT(std::abs(at("direction_y", 2)), 0.999);
}

TEST(CsvFiles, OfAnUnloadedDayAreReadByAProgram) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "report";
  const Ran ran =
      runProgram("report '" STIFFSCOPE_SOURCE_DIR "/samples/unloaded' --out '" + out.string() + "'", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  expectAllReadable(out, {"accuracy", "worst-postures", "calibrated-axes", "denavit-hartenberg", "places"});
}

TEST(CsvFiles, ACellOfWordsAndANameWithoutUnitAreSeen) {
  // The check itself: what the files had before.
  EXPECT_FALSE(isNumber("79.8 %"));
  EXPECT_FALSE(isNumber("91 to 93"));
  EXPECT_FALSE(isNumber("< 0.0001"));
  EXPECT_TRUE(isNumber("-1.5e-06"));
  EXPECT_FALSE(hasUnit("Complete Pose (CP)"));
  EXPECT_FALSE(hasUnit("95 % (%)"));
  EXPECT_TRUE(hasUnit("stiffness_nm_per_rad"));
  EXPECT_EQ(recordsOf("a,\"b,\"\"c\"\r\n1,\r\n"), (std::vector<Record>{{"a", "b,\"c"}, {"1", ""}}));
}

}  // namespace csv_files_test
}  // namespace stiffscope
