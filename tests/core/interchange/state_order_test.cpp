#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/interchange/import_day.h"
#include "core/io/units.h"
#include "tests/core/interchange/refusal.h"

// Days joined by order, of a few rows: which row of the log each posture has.

namespace stiffscope {
namespace state_order_test {

namespace fs = std::filesystem;
using namespace interchange;
using interchange_test::expectSays;
using Names = std::vector<std::string>;

class OrderedDay : public ::testing::Test {
 protected:
  OrderedDay() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(STIFFSCOPE_TEST_OUTPUT) / "state_order" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy_file(STIFFSCOPE_SOURCE_DIR "/samples/unloaded/robot.urdf", folder_ / "robot.urdf");
  }
  ~OrderedDay() override { fs::remove_all(folder_); }

  /// Points of these names; a lost beam where one ends in '!'.
  void writePoints(const std::string& file, const Names& names) const {
    std::ofstream out(folder_ / file);
    out << "name,x_mm,y_mm,z_mm\n";
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool lost = names[i].ends_with('!');
      out << (lost ? names[i].substr(0, names[i].size() - 1) + ",0,0,0"
                   : fmt::format("{},{},2000,300", names[i], 1000 + i))
          << '\n';
    }
  }

  /// Joint 1 of row n stands at 10 n degrees.
  void writeLog(int rows) const {
    std::ofstream out(folder_ / "log.csv");
    out << "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n";
    for (int row = 1; row <= rows; ++row) out << row << ',' << 10 * row << ",0,0,0,20,0\n";
  }

  ImportedDay imported(const std::string& points, const std::string& by = "order") const {
    std::ofstream(folder_ / "DAY.xml")
        << "<day format=\"1\" name=\"Cell\" date=\"2031-03-04\">\n"
           "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\"/>\n"
           "<targets><target id=\"P10\"/><target id=\"P11\"/><target id=\"P12\"/></targets>\n"
        << points << "<log file=\"log.csv\"/><join by=\"" << by << "\"/></day>\n";
    return importDay(folder_ / "DAY.xml");
  }

  /// "pose/step: row of the log" of the table of states.
  Names rows(const std::string& points) const {
    const ImportedDay made = imported(points);
    Names found;
    for (const campaign::State& state : made.campaign.states->rows)
      found.push_back(fmt::format("{}/{}: {}", made.campaign.pose_ids[static_cast<std::size_t>(state.pose)], state.step,
                                  std::lround(state.q[0] / io::kDegree / 10.0)));
    return found;
  }

  std::string refusal(const std::string& points, const std::string& by = "order") const {
    return interchange_test::refusalOf([&] { imported(points, by); });
  }

  fs::path folder_;
};

std::string named(const std::string& file) {
  return "<points role=\"loading\" file=\"" + file + "\" names=\"{target}_{pose}\"/>\n";
}

std::string ofTarget(const std::string& file, const std::string& target, const std::string& step = "0") {
  return fmt::format("<points role=\"loading\" file=\"{}\" target=\"{}\" step=\"{}\"/>\n", file, target, step);
}

const Names kInOrder{"1/0: 1", "2/0: 2", "3/0: 3", "4/0: 4"};

TEST_F(OrderedDay, ALostBeamOfTheFirstOfSeveralFilesMovesNoOtherPosture) {
  writeLog(4);
  writePoints("a.csv", {"SMR", "SMR!", "SMR", "SMR"});
  writePoints("b.csv", {"SMR", "SMR", "SMR", "SMR!"});
  EXPECT_EQ(rows(ofTarget("a.csv", "P10") + ofTarget("b.csv", "P11")), kInOrder);
}

TEST_F(OrderedDay, ARowThatOneReflectorLacksHasItsPlaceByTheOthers) {
  writeLog(4);
  // A file a reflector; one file reflector by reflector, and one posture by posture.
  writePoints("a.csv", {"P10_1", "P10_3", "P10_4"});
  writePoints("b.csv", {"P11_1", "P11_2", "P11_3", "P11_4"});
  EXPECT_EQ(rows(named("a.csv") + named("b.csv")), kInOrder);
  writePoints("c.csv", {"P10_1", "P10_3", "P10_4", "P11_1", "P11_2", "P11_3", "P11_4"});
  EXPECT_EQ(rows(named("c.csv")), kInOrder);
  writePoints("d.csv", {"P10_1", "P11_1", "P11_2", "P10_3", "P10_4", "P11_4"});
  EXPECT_EQ(rows(named("d.csv")), kInOrder);
  // The order is the files', not that of the names.
  writePoints("e.csv", {"P10_4", "P10_3", "P10_1", "P11_4", "P11_3", "P11_2", "P11_1"});
  EXPECT_EQ(rows(named("e.csv")), (Names{"4/0: 1", "3/0: 2", "2/0: 3", "1/0: 4"}));
}

TEST_F(OrderedDay, APostureOfLostBeamsAloneKeepsItsRowOfTheLog) {
  writeLog(4);
  writePoints("a.csv", {"P10_1", "P11_1", "P10_2!", "P11_2!", "P10_3", "P11_3", "P10_4", "P11_4"});
  EXPECT_EQ(rows(named("a.csv")), (Names{"1/0: 1", "3/0: 3", "4/0: 4"}));
  const ImportedDay made = imported(named("a.csv"));
  const auto unread = std::find_if(made.skipped.begin(), made.skipped.end(),
                                   [](const auto& one) { return one.row.reason == Skip::no_readings; });
  ASSERT_NE(unread, made.skipped.end());
  EXPECT_EQ(unread->row.line, 3u);
  writeLog(3);
  expectSays(refusal(named("a.csv")), {"log.csv", "as were read, 4, 1 of them by lost beams alone; it has 3 rows"});
}

TEST_F(OrderedDay, AnOrderThatNobodyKnowsIsRefused) {
  writeLog(4);
  // Which of 2 and 3 came first no reflector tells.
  writePoints("a.csv", {"P10_1", "P10_3", "P10_4"});
  writePoints("b.csv", {"P11_1", "P11_2", "P11_4"});
  expectSays(refusal(named("a.csv") + named("b.csv")), {"b.csv:3: pose: '2'", "pose 3", "a.csv line 3", "first"});
  // Two say otherwise.
  writePoints("b.csv", {"P11_1", "P11_4", "P11_2", "P11_3"});
  expectSays(refusal(named("a.csv") + named("b.csv")), {"pose: '", "one order", "a.csv", "b.csv"});
  // A second round has a posture that the first passed over.
  writePoints("c.csv", {"P10_1", "P10_3", "P10_4", "P10_1", "P10_2", "P10_3", "P10_4"});
  expectSays(refusal(named("c.csv")), {"c.csv:6: pose: '2'", "first round", "pose 1", "pose 3", "c.csv line 3"});
}

TEST_F(OrderedDay, NamesThatRepeatOnceAPoseDoSoInAllFiles) {
  writeLog(4);
  writePoints("a.csv", {"SMR", "SMR", "SMR"});
  writePoints("b.csv", {"SMR", "SMR", "SMR", "SMR"});
  const std::string both = ofTarget("a.csv", "P10") + ofTarget("b.csv", "P11");
  for (const char* by : {"order", "name"})
    expectSays(refusal(both, by), {"b.csv:5: name: 'SMR'", "4 times", "a.csv 3 times", "0 0 0"});
  // Another load step may have fewer poses.
  EXPECT_EQ(refusal(ofTarget("a.csv", "P10", "1") + ofTarget("b.csv", "P11"), "name"), "");
}

TEST_F(OrderedDay, FilesWithNothingInCommonFollowOneAnotherAsTheyAreListed) {
  writeLog(4);
  writePoints("a.csv", {"SMR", "SMR"});
  const std::string unloaded = ofTarget("a.csv", "P10") + ofTarget("a.csv", "P11"),
                    loaded = ofTarget("a.csv", "P10", "1") + ofTarget("a.csv", "P11", "1");
  EXPECT_EQ(rows(unloaded + loaded), (Names{"1/0: 1", "2/0: 2", "1/1: 3", "2/1: 4"}));
  EXPECT_EQ(rows(loaded + unloaded), (Names{"1/1: 1", "2/1: 2", "1/0: 3", "2/0: 4"}));
}

TEST_F(OrderedDay, AFileMayComeBackToPostures) {
  writeLog(4);
  writePoints("a.csv", {"P10_1", "P10_2", "P10_1", "P10_3", "P10_4", "P10_1"});
  EXPECT_EQ(rows(named("a.csv")), kInOrder);
  writePoints("a.csv", {"P10_1", "P10_2", "P10_3", "P10_4", "P10_3", "P10_2", "P10_1"});
  EXPECT_EQ(rows(named("a.csv")), kInOrder);
}

}  // namespace state_order_test
}  // namespace stiffscope
