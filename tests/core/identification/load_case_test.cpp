#include "core/identification/load_case.h"

#include <gtest/gtest.h>

#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "core/identification/noise_share.h"
#include "core/identification/remarks.h"

namespace stiffscope {
namespace load_case_test {

campaign::Campaign sample() {
  return campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
}

/// A posture's cases, of which all steps share the unloaded arm, are those of the steps one by one.
TEST(LoadCaseMaker, APosturesCasesAreThoseOfItsSteps) {
  const campaign::Campaign day = sample();
  const frames::LoadingGeometry geometry = identification::identify(day).geometry;
  const std::vector<int> steps{1, 2, 3};
  const identification::LoadReadings readings(day, steps);
  const identification::LoadCaseMaker maker(day, readings, geometry);
  ASSERT_TRUE(maker.any());
  std::vector<identification::LoadCase> by_posture;
  for (std::size_t pose = 0; pose < day.pose_ids.size(); ++pose) {
    for (identification::LoadCase& one : maker.ofPose(pose)) by_posture.push_back(std::move(one));
  }
  std::size_t compared = 0;
  for (const int step : steps) {
    for (const identification::LoadCase& one : identification::loadCases(day, readings, geometry, step)) {
      const auto same = std::find_if(by_posture.begin(), by_posture.end(), [&](const identification::LoadCase& other) {
        return other.pose == one.pose && other.step == one.step;
      });
      ASSERT_NE(same, by_posture.end()) << one.pose << ", step " << one.step;
      EXPECT_EQ(same->q_sagged, one.q_sagged);
      EXPECT_EQ(same->wrench.force, one.wrench.force);
      EXPECT_EQ(same->wrench.moment, one.wrench.moment);
      ASSERT_EQ(same->targets.size(), one.targets.size());
      ASSERT_EQ(same->flange_loaded.has_value(), one.flange_loaded.has_value());
      if (one.flange_loaded) EXPECT_EQ(same->flange_loaded->matrix(), one.flange_loaded->matrix());
      ++compared;
    }
  }
  EXPECT_EQ(compared, by_posture.size());
  EXPECT_EQ(compared, 57u);  // 19 postures, three steps
}

/// The noise of a displacement is that of the sights from where its readings were taken.
TEST(LoadCaseMaker, AMoveKnowsFromWhereItWasRead) {
  campaign::Campaign day = sample();
  const identification::Identification identified = identification::identify(day, identification::estimatesOnly());
  constexpr int kFirstOfSecond = 7;
  const Eigen::Vector3d second(6.0, 2.5, 0.1);
  day.stations = {{"A"}, {"B"}};
  for (campaign::LoadingReading& row : day.loading->rows) {
    if (row.pose >= kFirstOfSecond) row.station = 1, row.from = second;
  }
  const frames::LoadingGeometry& geometry = identified.geometry;
  std::size_t of_second = 0;
  for (const identification::LoadCase& one :
       identification::loadCases(day, identification::LoadReadings(day, {2}), geometry, 2)) {
    for (const identification::TargetMove& move : one.targets) {
      const bool by_second = one.pose >= kFirstOfSecond;
      EXPECT_EQ(move.station, by_second ? 1 : 0);
      if (by_second)
        EXPECT_LT((move.from - *geometry.r0_from_loading * second).norm(), 1e-12);
      else
        EXPECT_TRUE(move.from.array().isNaN().all());
      of_second += by_second;
      campaign::Tracker at_second = *day.tracker;
      if (by_second) at_second.station = second;
      identification::TargetMove by_declared = move;
      by_declared.from = campaign::kStationOfTracker;
      EXPECT_LT((identification::displacementCovariance(*day.tracker, *geometry.r0_from_loading, move) -
                 identification::displacementCovariance(at_second, *geometry.r0_from_loading, by_declared))
                    .norm(),
                1e-20);
    }
  }
  EXPECT_EQ(of_second, 3u * (19 - kFirstOfSecond));
}

/// Of a posture that was loaded a step fewer the return to zero has the number of the others' last load.
campaign::Campaign returnedEarly(campaign::Campaign day, int pose) {
  const auto renumber = [pose](auto& rows) {
    std::erase_if(rows, [pose](const auto& row) { return row.pose == pose && row.step == 3; });
    for (auto& row : rows) {
      if (row.pose == pose && row.step == 4) row.step = 3;
    }
  };
  renumber(day.states->rows);
  renumber(day.loading->rows);
  return day;
}

TEST(LoadCases, APostureThatIsBackAtZeroIsLeftOutByName) {
  constexpr int kPose = 6;
  const campaign::Campaign day = returnedEarly(sample(), kPose);
  const identification::Identification result = identification::identify(day, identification::estimatesOnly());
  EXPECT_EQ(result.step, 3);
  EXPECT_EQ(result.cases.size(), 18u);
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_EQ(result.left_out[0].pose, day.pose_ids[kPose]);
  EXPECT_TRUE(result.left_out[0].reason.is(identification::RemarkId::back_at_zero));
  // Its noise has no direction: the load hangs as the others say.
  EXPECT_TRUE(result.identifiability.load_hangs);

  identification::IdentifyOptions options = identification::estimatesOnly();
  options.all_steps = true;
  const identification::Identification of_all = identification::identify(day, options);
  EXPECT_EQ(of_all.cases.size(), 56u);  // 19 postures, three steps, but for that one
  ASSERT_EQ(of_all.left_out.size(), 1u);
  EXPECT_TRUE(of_all.left_out[0].reason.is(identification::RemarkId::in_step));
}

/// What asks for the way back has it: hysteresis by posture, and a step in which all postures are back at zero.
TEST(LoadCases, ReturnsToZeroAreThereWhereTheyAreAskedFor) {
  constexpr int kPose = 6;
  const campaign::Campaign all = sample(), early = returnedEarly(all, kPose);
  const frames::LoadingGeometry geometry = identification::identify(all, identification::estimatesOnly()).geometry;
  EXPECT_EQ(identification::loadCases(all, geometry, 4).size(), 19u);
  const identification::LoadReadings readings(early, {1, 2, 3});
  EXPECT_TRUE(readings.backAtZero(kPose, 3));
  EXPECT_FALSE(readings.backAtZero(kPose, 2));
  EXPECT_FALSE(readings.backAtZero(kPose + 1, 3));
  EXPECT_EQ(identification::LoadCaseMaker(early, readings, geometry).ofPose(kPose).size(), 3u);
}

/// Leaving out what judges the estimates does not change them.
TEST(EstimatesOnly, AreTheEstimates) {
  const campaign::Campaign day = sample();
  const identification::Identification all = identification::identify(day, identification::valuesOnly());
  const identification::Identification quick = identification::identify(day, identification::estimatesOnly());
  ASSERT_EQ(all.methods.size(), quick.methods.size());
  for (std::size_t m = 0; m < all.methods.size(); ++m) {
    ASSERT_TRUE(quick.methods[m].available);
    EXPECT_EQ(all.methods[m].estimate.compliance, quick.methods[m].estimate.compliance);
  }
}

}  // namespace load_case_test
}  // namespace stiffscope
