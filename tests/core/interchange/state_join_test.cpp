#include "core/interchange/state_join.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/interchange/state_samples.h"

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

  JoinTask task(Role role = Role::loading) const { return {day_, robot_, day_.logs.front(), log_, "lab/b.csv", role}; }

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

  /// Force along z of the samples from one on, N; those before have none until they are set.
  void setForce(std::size_t from, double newtons) {
    for (std::size_t i = 0; i < log_.samples.size(); ++i) {
      if (i >= from || !log_.samples[i].wrench.allFinite()) log_.samples[i].wrench = Vector6d::Unit(2) * 0.0;
      if (i >= from) log_.samples[i].wrench[2] = newtons;
    }
  }

  double meanForce(const JoinedState& state) const { return meansOf(log_, state.first, state.last).wrench[2]; }

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
  expectSays(refusal(joinByName), {"lab/b.csv:4", "P[7]", "joints", "line 2 differs"});
  expectSays(refusal(joinByOrder), {"lab/b.csv", "as were read, 1; it has 3 rows"});
}

TEST_F(StateJoins, AStepThatTheLogLacksIsRefusedByPoseAndStep) {
  for (const int step : {0, 1, 3}) {
    addTarget("P[A]", 20.0);
    log_.samples.back().step = step;
    addReading("A", step, 0.0);
  }
  EXPECT_EQ(joinByName(task(), readings()).states[2].first, 2u);
  addReading("A", 2, 0.0);
  expectSays(refusal(joinByName), {"lab/a.txt:4: step: '2'", "pose A", "lab/b.csv"});
}

TEST_F(StateJoins, StepsThatWouldShareAWrenchOrAMotorsAngleAreRefused) {
  addTarget("P[A]", 20.0);
  addReading("A", 1, 0.0);
  setForce(0, -500.0);
  EXPECT_EQ(joinByName(task(), readings()).states.size(), 1u);
  addReading("A", 0, 0.0);
  expectSays(refusal(joinByName), {"lab/a.txt:2: step: '0'", "pose A", "lab/b.csv", "line 2", "those of step 1"});
  // Joints alone hold for all steps where the wrench comes from elsewhere, but for the motors'.
  day_.loads.emplace_back();
  EXPECT_EQ(joinByName(task(), readings()).states.size(), 2u);
  log_.motor_side.emplace_back(log_.samples[0].figures);
  expectSays(refusal(joinByName), {"lab/a.txt:2: step: '0'", "motors' side"});
}

TEST_F(StateJoins, ByTheClockTheWrenchIsThatOfTheReadings) {
  addSamples(10.0, 100);
  for (int i = 0; i < 20; ++i) addSamples(11.0 + i, 1);
  setForce(0, 0.0);
  setForce(20, -1500.0);  // put on 2 s after the arm stands
  setForce(100, 0.0);
  day_.clock.offset_s = 0.0;
  for (const double time : {5.05, 6.05}) addReading("", 0, time);
  const StateJoin join = joinByClock(task(), readings());
  EXPECT_DOUBLE_EQ(meanForce(join.states[0]), -1500.0);
  // Between the readings, to the last digit of their times, which is added to either side.
  EXPECT_EQ(join.states[0].first, 50u);
  EXPECT_EQ(join.states[0].last, 61u);
  EXPECT_TRUE(join.warnings.empty());
}

TEST_F(StateJoins, AWrenchThatChangesBetweenTheReadingsIsRefused) {
  addSamples(10.0, 100);
  setForce(0, 0.0);
  setForce(20, -1500.0);
  day_.clock.offset_s = 0.0;
  for (const double time : {1.0, 6.0}) addReading("", 0, time);
  expectSays(refusal(joinByClock), {"lab/b.csv:22: fz: '-1500.0 N'", "pose 1", "0.0 N"});
  // The standstill is all that is known of a log alone, and of one by order.
  readings_.resize(1);
  expectSays(refusal(joinByOrder), {"lab/b.csv:22: fz: '-1500.0 N'", "clock"});
  expectSays(interchange_test::refusalOf([&] { posturesOf(task()); }), {"lab/b.csv:22: fz: '-1500.0 N'", "every_s"});
  // A load that rises all the while, too.
  for (std::size_t i = 0; i < 100; ++i) log_.samples[i].wrench[2] = -15.0 * static_cast<double>(i);
  EXPECT_NE(refusal(joinByOrder), "");
  // Where a file has the loads, or a sweep takes the joints alone, the log's wrench is of no matter.
  EXPECT_EQ(joinByOrder(task(Role::wrist_sweep), readings()).states.size(), 1u);
  day_.loads.emplace_back();
  EXPECT_EQ(refusal(joinByOrder), "");
}

TEST_F(StateJoins, TheScatterOfALoadCellIsNoChange) {
  addSamples(10.0, 200);
  setForce(0, 0.0);
  std::mt19937 draw(7);
  std::normal_distribution<double> noise(0.0, 3.0);
  double sum = 0.0;
  for (JointSample& sample : log_.samples) sum += sample.wrench[2] = -2.0 + noise(draw);
  addReading("A", 0, 0.0);
  const StateJoin join = joinByOrder(task(), readings());
  EXPECT_NEAR(meanForce(join.states[0]), sum / 200.0, 1e-9);
  // A weight that swings, and creeps by a percent.
  for (std::size_t i = 0; i < 200; ++i)
    log_.samples[i].wrench[2] = -1500.0 + 30.0 * std::sin(0.4 * static_cast<double>(i)) + 0.07 * static_cast<double>(i);
  EXPECT_EQ(refusal(joinByOrder), "");
}

TEST_F(StateJoins, AWrenchThatChangesCloserThanTheClocksAreKnownIsWarnedOf) {
  // Stands that follow one another unevenly, so that one offset serves, which they bound to some seconds.
  for (int pose = 0; pose < 6; ++pose) {
    addSamples(10.0 * pose, 120 + 7 * pose);
    for (int i = 0; i < 20 + 17 * pose * pose; ++i) addSamples(10.0 * pose + 0.2 + 0.3 * (i % 20), 1);
  }
  const auto stands = standstillsOf(log_.samples, day_.clock.standstill);
  ASSERT_EQ(stands.size(), 6u);
  for (const Standstill& still : stands) {
    for (const double time : {8.0, 9.0}) addReading("", 0, still.from_s + time);
  }
  setForce(0, 0.0);
  EXPECT_TRUE(joinByClock(task(), readings()).warnings.empty());
  const StateJoin unloaded = joinByClock(task(), readings());
  ASSERT_GT(unloaded.clock->uncertainty_s, 1.0);
  // Put on half of that before the first reading, as the offset has it.
  const double before = 0.5 * unloaded.clock->uncertainty_s;
  for (const Standstill& still : stands) {
    for (std::size_t i = still.first; i <= still.last; ++i) {
      const double at = *log_.samples[i].time_s - unloaded.clock->offset_s;
      log_.samples[i].wrench[2] = at < still.from_s + 8.0 - before ? 0.0 : -1500.0;
    }
  }
  const StateJoin join = joinByClock(task(), readings());
  EXPECT_DOUBLE_EQ(meanForce(join.states[0]), -1500.0);
  ASSERT_EQ(join.warnings.size(), 1u);
  expectSays(join.warnings[0], {"lab/b.csv", "6 states", "pose 1", "+- "});
}

TEST_F(StateJoins, RowsOfOnePoseThatDifferAreRefusedAndEqualOnesAreMerged) {
  for (const char* pose : {"P[1]", "P[1]", "P[2]"}) addTarget(pose, 20.0);
  setForce(0, 0.0);
  StateJoin join = posturesOf(task());
  EXPECT_EQ(join.states.size(), 2u);
  EXPECT_EQ(join.merged, std::vector<std::size_t>{1});
  addReading("1", 0, 0.0);
  EXPECT_EQ(joinByName(task(), readings()).merged, std::vector<std::size_t>{1});
  const auto refused = [&] { return interchange_test::refusalOf([&] { posturesOf(task()); }); };
  log_.samples[1].wrench[2] = -1500.0;
  expectSays(refused(), {"lab/b.csv:3", "P[1]", "wrench", "line 2", "column step"});
  expectSays(refusal(joinByName), {"lab/b.csv:3", "wrench"});
  EXPECT_EQ(joinByName(task(Role::wrist_sweep), readings()).states.size(), 1u);  // takes the joints alone
  log_.samples[1].wrench[2] = 0.0;
  log_.samples[1].temperature_c = 21.0;
  log_.samples[0].temperature_c = 20.0;
  expectSays(refused(), {"lab/b.csv:3", "temperature"});
  log_.samples[1].temperature_c = 20.0;
  for (std::size_t i = 0; i < 3; ++i) log_.samples[i].tool_pose.position.setConstant(i == 1 ? 1.0 : 0.5);
  expectSays(refused(), {"lab/b.csv:3", "pose of the tool"});
  // Of steps that are told apart each is a state.
  log_.samples[0].step = 0;
  log_.samples[1].step = 1;
  EXPECT_EQ(posturesOf(task()).states.size(), 3u);
}

TEST_F(StateJoins, OfALogWithPoseAndIndexStatesHaveThePoseAndSweepsTheIndex) {
  for (const char* pose : {"A", "A", "B"}) {
    addTarget("P[" + std::string(pose) + "]", 20.0);
    log_.index.push_back("P[" + std::to_string(log_.index.size() + 1) + "]");
  }
  addReading("A", 0, 0.0);
  EXPECT_EQ(joinByName(task(), readings()).states[0].first, 0u);
  readings_[0].pose = "3";
  EXPECT_EQ(joinByName(task(Role::wrist_sweep), readings()).states[0].first, 2u);
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
