#include "core/mistakes/arm_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include "core/mistakes/remarks.h"
#include "tests/fixtures/simulated_lab.h"

// Mistakes with a size of their own, in a rigid day that is otherwise exact: the size that is found is the one put in.
// Those of the table are find_mistakes_test's.

namespace stiffscope {
namespace arm_search_test {

using mistakes::ArmCure;
using mistakes::ArmSearch;
using mistakes::ReadingsOfDay;
using mistakes::RemarkId;
using mistakes::SourceTable;

class Search : public ::testing::Test {
 protected:
  Search() {
    lab.withoutMasses();
    campaign = fullDay(lab, [](int) { return Eigen::Vector3d(0.0, 0.0, -800.0); });
    day = mistakes::readingsOf(campaign);
  }

  /// The one cure, whose remedy is of this kind.
  ArmCure cure(RemarkId remedy) {
    ArmSearch search = mistakes::searchArm(campaign, day);
    EXPECT_EQ(search.cures.size(), 1u);
    if (search.cures.empty()) return {};
    EXPECT_TRUE(search.cures.front().suspected.remedy.is(remedy)) << search.cures.front().suspected.mistake.name();
    EXPECT_LT(search.cures.front().suspected.after, 0.01 * search.cures.front().suspected.before);
    return std::move(search.cures.front());
  }

  /// From a posture on (an index) each gets the angles of the one so many after it, the last ones those of the last.
  void takeRowsOf(int first, int later) {
    for (const campaign::State& state : campaign.states->rows) truth.emplace(state.pose, state.q);
    const int last = static_cast<int>(truth.size()) - 1;
    for (campaign::State& state : campaign.states->rows) {
      if (state.pose >= first) state.q = truth.at(std::min(state.pose + later, last));
    }
    day = mistakes::readingsOf(campaign);
  }

  /// With the cure every posture has its own angles, but the one whose row is in no file, which is left out.
  void expectTruthWithout(int lost, const ArmCure& found) {
    std::map<int, int> readings;
    for (const mistakes::UnloadedReading& reading : found.day.unloaded) {
      if (reading.pose < 0) continue;
      ++readings[reading.pose];
      EXPECT_EQ(reading.q, truth.at(reading.pose)) << reading.pose;
    }
    for (const mistakes::LoadedReading& reading : found.day.loaded) {
      EXPECT_TRUE(readings.contains(reading.pose)) << reading.pose;
      EXPECT_EQ(reading.q, truth.at(reading.pose)) << reading.pose;
    }
    EXPECT_FALSE(readings.contains(lost));
    EXPECT_EQ(readings.size(), truth.size() - 1);
  }

  static double number(const ArmCure& cure, std::size_t place) {
    return std::get<double>(cure.suspected.remedy.values.at(place));
  }
  static std::int64_t count(const ArmCure& cure, std::size_t place) {
    return std::get<std::int64_t>(cure.suspected.remedy.values.at(place));
  }

  SimulatedLab lab;
  campaign::Campaign campaign;
  ReadingsOfDay day;
  std::map<int, JointVector> truth;  ///< angles by posture, before they were shifted
};

TEST_F(Search, AGoodDayNeedsNoCure) {
  const ArmSearch search = mistakes::searchArm(campaign, day);
  EXPECT_FALSE(search.contradicts);
  EXPECT_TRUE(search.cures.empty());
}

// To a part in a thousand of a radian: the search ends at a step of 1e-5 rad.
TEST_F(Search, AZeroOffInAllTables) {
  for (mistakes::UnloadedReading& reading : day.unloaded) reading.q[2] += 0.13;
  const ArmCure found = cure(RemarkId::shift_zero);
  EXPECT_EQ(count(found, 0), 3);
  EXPECT_NEAR(number(found, 1), -0.13, 1e-3);
  EXPECT_EQ(count(found, 2), 1);  // everywhere
}

TEST_F(Search, AZeroOffInTheLoadingAlone) {
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.table == SourceTable::loading) reading.q[1] -= 0.2;
  }
  const ArmCure found = cure(RemarkId::shift_zero);
  EXPECT_EQ(count(found, 0), 2);
  EXPECT_NEAR(number(found, 1), 0.2, 1e-3);
  EXPECT_EQ(count(found, 2), 0);
}

// A URDF whose upper arm is 150 mm too long: joint 3 stands nearer to joint 2, whose link is upright at zero.
TEST_F(Search, AnOriginOfTheRobot) {
  ChainArm longer = lab.nominal;
  longer.to_joint[2].translation().z() += 0.15;
  day.robot = longer.robot();
  const ArmCure found = cure(RemarkId::origin_off);
  EXPECT_EQ(count(found, 0), 3);
  const auto& shift = std::get<std::vector<double>>(found.suspected.remedy.values.at(1));
  EXPECT_NEAR(shift[2], -0.15, 2e-3);  // of a shift to first order
  EXPECT_TRUE(std::get<std::vector<double>>(found.suspected.remedy.values.at(2)).empty());
}

// Along its own axis the origin of joint 6 does what the reflectors' places on the flange do: of a shift across it and
// along it, the part across is named, and that along it is said not to be seen.
TEST_F(Search, AnOriginAlongItsAxisIsNotToldFromTheReflectors) {
  ChainArm off = lab.nominal;
  const metrology::Line before = off.robot().axes_in_base_at_zero[5];
  off.to_joint[5].translation() += Eigen::Vector3d(0.06, 0.06, 0.06);
  day.robot = off.robot();
  const Eigen::Vector3d axis = before.direction, back = before.point - day.robot.axes_in_base_at_zero[5].point;
  const ArmCure found = cure(RemarkId::origin_off);
  EXPECT_EQ(count(found, 0), 6);
  const auto& shift = std::get<std::vector<double>>(found.suspected.remedy.values.at(1));
  const auto& unseen = std::get<std::vector<double>>(found.suspected.remedy.values.at(2));
  ASSERT_EQ(unseen.size(), 3u);
  const Eigen::Vector3d named(shift[0], shift[1], shift[2]), direction(unseen[0], unseen[1], unseen[2]);
  EXPECT_NEAR(std::abs(direction.dot(axis)), 1.0, 1e-6);
  EXPECT_NEAR(named.dot(axis), 0.0, 1e-9);
  EXPECT_NEAR((named - (back - axis.dot(back) * axis)).norm(), 0.0, 2e-3);  // to first order, as above
}

TEST_F(Search, ATableOfAnotherScale) {
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.table == SourceTable::circle_sweeps) reading.point *= 1.02;
  }
  EXPECT_NEAR(number(cure(RemarkId::table_scale_off), 0), 0.02, 2e-3);
}

TEST_F(Search, PointsAndRobotOfDifferentSize) {
  for (mistakes::UnloadedReading& reading : day.unloaded) reading.point *= 1.004;
  EXPECT_NEAR(number(cure(RemarkId::scale_off), 0), 0.004, 1e-5);
}

TEST_F(Search, ATableFromAnotherStation) {
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(0.4, -0.2, 0.1) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.table == SourceTable::loading) reading.point = moved * reading.point;
  }
  const ArmCure found = cure(RemarkId::other_station);
  EXPECT_NEAR(number(found, 0), moved.inverse().translation().norm(), 1e-5);
  EXPECT_NEAR(number(found, 1), 0.3, 1e-5);
}

// The tracker's frame taken for base_link: the readings fit, and the frame stands where the tracker's does.
TEST_F(Search, PointsThatAreNotInBaseLink) {
  campaign.loading->frame = campaign::PointFrame::base_link;
  ArmSearch search = mistakes::searchArm(campaign, day);
  ASSERT_EQ(search.cures.size(), 1u);
  EXPECT_FALSE(search.contradicts);
  EXPECT_TRUE(search.cures[0].suspected.remedy.is(RemarkId::not_in_base));
  EXPECT_NEAR(number(search.cures[0], 0), lab.tracker_from_base.inverse().translation().norm(), 1e-6);
  EXPECT_NEAR(number(search.cures[0], 1), Eigen::AngleAxisd(lab.tracker_from_base.linear()).angle(), 1e-6);
}

TEST_F(Search, TwoPosturesWhoseAnglesAreExchanged) {
  JointVector first = JointVector::Zero(6), second = first;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.pose == 3) first = state.q;
    if (state.pose == 6) second = state.q;
  }
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.pose == 3) reading.q = second;
    if (reading.pose == 6) reading.q = first;
  }
  const ArmCure found = cure(RemarkId::angles_exchanged);
  EXPECT_EQ(std::get<std::string>(found.suspected.remedy.values.at(0)), "4");
  EXPECT_EQ(std::get<std::string>(found.suspected.remedy.values.at(1)), "7");
}

// The angles of pose 4 are in no row: those of each later one stand in the row before its own.
TEST_F(Search, ALostRowOfAngles) {
  takeRowsOf(3, 1);
  const ArmCure found = cure(RemarkId::rows_lost);
  EXPECT_EQ(std::get<std::string>(found.suspected.remedy.values.at(0)), "4");
  EXPECT_EQ(count(found, 1), 1);  // the next posture's
  expectTruthWithout(3, found);
  EXPECT_LT(found.rms, 1e-6);  // of a rigid arm, by a robust fit that the shifted postures still pull a little
}

// The angles of pose 3 are in two rows, and those of the last posture in none.
TEST_F(Search, ADoubledRowOfAngles) {
  takeRowsOf(3, -1);
  const ArmCure found = cure(RemarkId::rows_lost);
  EXPECT_EQ(std::get<std::string>(found.suspected.remedy.values.at(0)), "4");
  EXPECT_EQ(count(found, 1), 0);  // the one's before
  expectTruthWithout(9, found);
  EXPECT_LT(found.rms, 1e-6);
}

// A row too many leaves the posture before it its own: one whose points are wrong besides is none of those.
TEST_F(Search, ADoubledRowBehindABadPosture) {
  takeRowsOf(3, -1);
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.pose == 2) reading.point.x() += 0.5;
  }
  EXPECT_EQ(std::get<std::string>(cure(RemarkId::rows_lost).suspected.remedy.values.at(0)), "4");
}

}  // namespace arm_search_test
}  // namespace stiffscope
