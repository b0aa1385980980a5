#include "core/interchange/state_join.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/interchange/refusal.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace state_join_test {

using namespace interchange;
using interchange_test::expectSays;

constexpr double kDeg = std::numbers::pi / 180.0;

/// Readings and a log that a test fills in, and the task of joining them.
class StateJoins : public ::testing::Test {
 protected:
  StateJoins() {
    std::vector<std::string> warnings;
    day_ = parseDayDescription(
        "lab/DAY.xml",
        "<day format=\"1\" name=\"C\" date=\"d\"><robot urdf=\"r\" base_link=\"b\" flange_link=\"t\"/>"
        "<targets><target id=\"P10\"/></targets><points role=\"loading\" file=\"a.txt\"/>"
        "<log file=\"b.csv\" names=\"P[{pose}]\"/><join by=\"clock\"/></day>",
        warnings);
  }

  JoinTask task() const { return {day_, robot_, day_.logs.front(), log_, "lab/b.csv"}; }

  /// Samples at 10 Hz of joint 2 (deg), from the last time on.
  void addSamples(double degrees, int count) {
    for (int i = 0; i < count; ++i) {
      JointSample sample(robot_.joints());
      sample.time_s = 0.1 * static_cast<double>(log_.samples.size());
      sample.figures[1] = degrees * kDeg;
      sample.line = log_.samples.size() + 2;
      log_.samples.push_back(sample);
    }
  }

  void addTarget(const std::string& name, double degrees) {
    addSamples(degrees, 1);
    log_.samples.back().time_s.reset();
    log_.samples.back().name = name;
  }

  void addReading(const std::string& pose, int step, double time_s) {
    DayReading reading;
    reading.line = static_cast<std::uint32_t>(readings_.size() + 1);
    reading.time_s = time_s;
    reading.resolution_s = 0.1;
    reading.pose = pose;
    reading.step = step;
    readings_.push_back(reading);
  }

  const std::vector<DayReading>& readings() const { return readings_; }

  template <class Join>
  std::string refusal(const Join& join) {
    return interchange_test::refusalOf([&] { join(task(), readings()); });
  }

  DayDescription day_;
  robot::Robot robot_ = exampleChain().robot();
  RobotLog log_;
  std::vector<DayReading> readings_;
};

TEST_F(StateJoins, StepsThatShareAStandstillHaveTheSamplesOfTheirOwnReadings) {
  // The servo gives way by 0.01 deg under load, which the band of 0.02 deg lets stand still.
  addSamples(10.0, 100);
  addSamples(10.01, 100);
  for (int i = 0; i < 30; ++i) addSamples(11.0 + i, 1);
  addSamples(50.0, 100);
  day_.clock.offset_s = 0.0;
  for (const double time : {4.0, 5.0, 6.0}) addReading("", 0, time);
  for (const double time : {14.0, 15.0, 16.0}) addReading("", 1, time);
  for (const double time : {26.0, 27.0, 28.0, 29.0}) addReading("", 0, time);
  addReading("", 0, 21.5);  // in motion
  const StateJoin join = joinByClock(task(), readings());
  ASSERT_EQ(join.states.size(), 3u);
  EXPECT_NEAR(join.states[0].figures[1], 10.0 * kDeg, 1e-15);
  EXPECT_NEAR(join.states[1].figures[1], 10.01 * kDeg, 1e-15);
  EXPECT_EQ(join.states[0].pose, "1");
  EXPECT_EQ(join.states[1].pose, "1");
  EXPECT_EQ(join.states[1].step, 1);
  EXPECT_EQ(join.states[2].pose, "2");
  ASSERT_EQ(join.left_out.size(), 1u);
  EXPECT_EQ(join.left_out[0], (std::pair<std::size_t, Skip>(10, Skip::in_motion)));
}

TEST_F(StateJoins, APoseInTwoStandstillsIsRefusedWithBothLines) {
  addSamples(10.0, 100);
  addSamples(50.0, 100);
  day_.clock.offset_s = 0.0;
  addReading("A", 0, 5.0);
  addReading("A", 0, 15.0);
  expectSays(refusal(joinByClock), {"lab/a.txt:2", "'A'", "one standstill", "line 1"});
}

TEST_F(StateJoins, ByTheClockEveryReadingAndSampleNeedsItsTime) {
  addSamples(10.0, 100);
  addReading("", 0, 5.0);
  readings_[0].time_s = campaign::kNoTime;
  expectSays(refusal(joinByClock), {"lab/a.txt:1", "time"});
  log_.samples[50].time_s.reset();
  expectSays(refusal(joinByClock), {"lab/b.csv", "rate_hz"});
}

TEST_F(StateJoins, NamesOfALogWithoutStepsHoldForAllSteps) {
  addTarget("P[7]", 20.0);
  addTarget("P[8]", 30.0);
  addTarget("home", 0.0);
  addReading("8", 0, 1.0);
  addReading("8", 1, 2.0);
  const StateJoin join = joinByName(task(), readings());
  ASSERT_EQ(join.states.size(), 2u);
  EXPECT_NEAR(join.states[0].figures[1], 30.0 * kDeg, 1e-15);
  EXPECT_EQ(join.states[1].first, 1u);
  EXPECT_EQ(join.stretches.size(), 2u);  // P[7] and P[8]; home is no pose
}

TEST_F(StateJoins, OnePoseWithTwoPosturesIsRefused) {
  addTarget("P[7]", 20.0);
  addTarget("P[7]", 20.0);  // a table with a row a reflector
  addReading("7", 0, 1.0);
  EXPECT_EQ(joinByName(task(), readings()).states.size(), 1u);
  addTarget("P[7]", 20.1);
  expectSays(refusal(joinByName), {"lab/b.csv:4", "P[7]", "line 2 has others"});
  expectSays(refusal(joinByOrder), {"lab/b.csv", "as were read, 1; it has 3 rows"});
}

TEST_F(StateJoins, ByOrderStandstillsServeWhereRowsAreSamples) {
  addSamples(10.0, 100);
  addSamples(50.0, 100);
  addReading("A", 0, 0.0);
  addReading("B", 0, 0.0);
  const StateJoin join = joinByOrder(task(), readings());
  EXPECT_NEAR(join.states[0].figures[1], 10.0 * kDeg, 1e-15);
  EXPECT_NEAR(join.states[1].figures[1], 50.0 * kDeg, 1e-15);
  EXPECT_EQ(join.states[1].first, 100u);
}

}  // namespace state_join_test
}  // namespace stiffscope
