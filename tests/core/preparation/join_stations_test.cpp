#include "core/preparation/join_stations.h"

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "core/audit/audit.h"
#include "core/identification/identify.h"
#include "core/io/input_error.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/station_day.h"

// Days that a tracker read from two places.

namespace stiffscope {
namespace join_stations_test {

identification::Identification identified(const preparation::PreparedCampaign& day) {
  identification::IdentifyOptions quick;
  quick.subsets.most_all = 1;
  quick.subsets.sample = 1;
  return identification::identify(day.campaign, quick);
}

/// Largest difference of a method's stiffness, in parts of it.
double farthestApart(const identification::Identification& a, const identification::Identification& b,
                     identification::Method method) {
  double farthest = 0.0;
  int compared = 0;
  const identification::MethodResult &first = a.of(method), &second = b.of(method);
  EXPECT_TRUE(first.available && second.available);
  for (int j = 0; j < 6; ++j) {
    if (!first.estimate.identifiable[static_cast<std::size_t>(j)]) continue;
    farthest = std::max(farthest, std::abs(second.estimate.compliance[j] / first.estimate.compliance[j] - 1.0));
    ++compared;
  }
  EXPECT_GE(compared, 5);  // all joints but the one that the load does not turn
  return farthest;
}

std::string refusalOf(campaign::Campaign day) {
  try {
    preparation::prepareCampaign(std::move(day));
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "not refused";
}

/// Readings as good as exact; without any noise repeats would pass for copies of each other.
constexpr double kExact = 1e-6;

// What a second station reads in a frame of its own is the same day, once nests have joined the two.
// A millionth of the tracker's noise, 2e-11 m, in the pose turns displacements by 1e-11.
TEST(JoinStations, ADaySplitInTwoIsTheSameDay) {
  simulation::SimulationSpec spec = cleanDay(41, kExact);
  spec.read_back_resolution = 0.0;  // what it leaves of a fit would be weighed by the standpoint
  const campaign::Campaign whole = simulation::simulate(spec);
  const preparation::PreparedCampaign one = preparation::prepareCampaign(whole),
                                      two = preparation::prepareCampaign(seenFromTwo(whole, 10));
  ASSERT_TRUE(two.preparation.stations);
  double farthest = 0.0;
  for (std::size_t i = 0; i < whole.loading->rows.size(); ++i) {
    const campaign::LoadingReading& row = two.campaign.loading->rows[i];
    farthest = std::max(farthest, (row.point - one.campaign.loading->rows[i].point).norm());
    const Eigen::Vector3d stood =
        row.pose < 10 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : secondStation().translation();
    ASSERT_LT((row.from - stood).norm(), 1e-9);
  }
  EXPECT_LT(farthest, 1e-9);
  const identification::Identification by_one = identified(one), by_two = identified(two);
  EXPECT_LT(farthestApart(by_one, by_two, identification::Method::complete_pose), 1e-9);
  EXPECT_LT(farthestApart(by_one, by_two, identification::Method::decoupled_partial_pose), 1e-9);
  // Its calibration weighs what the linear sag leaves of positions, by the sight from where each was read.
  EXPECT_LT(farthestApart(by_one, by_two, identification::Method::partial_pose), 1e-6);
}

// asMeasured puts back a drift of each station, not its frame.
TEST(JoinStations, EachStationsOwnDriftIsTakenOffAndPutBack) {
  simulation::SimulationSpec spec = carriedDay(42, kExact);
  spec.timing.nest_interval_s = 600.0;
  const preparation::PreparedCampaign still = preparation::prepareCampaign(simulation::simulate(spec));
  EXPECT_FALSE(still.preparation.drift.taken_off);
  spec.station.ramp << 1e-7, 0.0, 5e-8, 0.0, 0.0, 1e-8;  // m/s, rad/s: some 0.4 mm and 40 urad an hour
  const campaign::Campaign read = simulation::simulate(spec);
  const preparation::PreparedCampaign drifting = preparation::prepareCampaign(read);
  ASSERT_TRUE(drifting.preparation.drift.taken_off) << reports::words(drifting.preparation.drift.reason);
  const preparation::JoinedStations& stations = *drifting.preparation.stations;
  EXPECT_EQ(stations.courses[0].course, preparation::StationCourse::drifted);
  EXPECT_EQ(stations.courses[1].course, preparation::StationCourse::drifted);
  // Once it is taken off the nests of both stand still.
  EXPECT_EQ(drifting.drift.course, preparation::StationCourse::still);
  // The readings are those of a tracker that stood still, but for what it drifts while a round of the nests is read:
  // 1.3 um in ten seconds, some more through the pose that they give.
  double farthest = 0.0;
  ASSERT_EQ(drifting.campaign.loading->rows.size(), still.campaign.loading->rows.size());
  for (std::size_t i = 0; i < read.loading->rows.size(); ++i) {
    const Eigen::Vector3d off = drifting.campaign.loading->rows[i].point - still.campaign.loading->rows[i].point;
    farthest = std::max(farthest, off.norm());
  }
  EXPECT_LT(farthest, 5e-6);
  const preparation::PreparedCampaign put_back = preparation::asMeasured(drifting);
  const Eigen::Isometry3d pose = stations.network.stations[1].first_from_station;
  for (std::size_t i = 0; i < read.loading->rows.size(); ++i) {
    const campaign::LoadingReading& row = read.loading->rows[i];
    const Eigen::Vector3d as_read = row.station == 0 ? row.point : pose * row.point;
    ASSERT_LT((put_back.campaign.loading->rows[i].point - as_read).norm(), 1e-9);
  }
}

// 95 % regions of the second station's pose over fresh days hold its place: 300 days, three binomial deviations. The
// days have nests alone, so that as many can be made.
TEST(JoinStations, StatedPoseHoldsTheTruthAsOftenAsItSays) {
  constexpr int kDays = 300;
  const double limit = quantile(boost::math::chi_squared(6.0), 0.95);
  int held = 0;
  for (int day = 0; day < kDays; ++day) {
    simulation::SimulationSpec spec = carriedDay(5000 + static_cast<std::uint64_t>(day), 1.0);
    spec.loading.reset();
    spec.posture_draw->count = 12;
    spec.posture_draw->candidates = 1;
    spec.unloaded_repeats = 1;
    spec.circle_sweeps.clear();
    spec.wrist_sweep.reset();
    const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
    const preparation::StationPose& pose = prepared.preparation.stations->network.stations[1];
    const Eigen::Isometry3d off = pose.first_from_station * secondStation().inverse();
    const Eigen::AngleAxisd turn(off.linear());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), off * pose.centre - pose.centre;
    held += error.dot(pose.covariance.ldlt().solve(error)) <= limit;
  }
  RecordProperty("held_percent", std::to_string(100.0 * held / kDays));
  EXPECT_NEAR(static_cast<double>(held) / kDays, 0.95, 3.0 * std::sqrt(0.95 * 0.05 / kDays));
}

// A day on which the tracker was carried to a second place: stiffnesses hold the truth by the stated intervals. Of four
// days with fifteen intervals or more each of 95 %, more than eight outside have a chance below one in a thousand.
TEST(JoinStations, ACarriedDayHoldsTheTruth) {
  int stated = 0, outside = 0;
  for (std::uint64_t seed = 7100; seed < 7104; ++seed) {
    const simulation::SimulationSpec spec = carriedDay(seed, 1.0);
    const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
    ASSERT_TRUE(prepared.preparation.stations);
    EXPECT_GT(prepared.preparation.stations->readings[1], 300u);
    for (const identification::MethodResult& method : identified(prepared).methods) {
      ASSERT_TRUE(method.available) << reports::words(method.reason);
      for (int j = 0; j < 6; ++j) {
        if (!method.estimate.identifiable[static_cast<std::size_t>(j)]) continue;
        ++stated;
        outside += !identification::stiffnessInterval(method.estimate, j)
                        .holds(*spec.machine.joints[static_cast<std::size_t>(j)].torsion);
      }
    }
  }
  RecordProperty("outside", std::to_string(outside) + " of " + std::to_string(stated));
  EXPECT_GE(stated, 60);
  EXPECT_LE(outside, 8);
}

const preparation::AuditCheck* checkOf(const audit::AuditReport& report, const std::string& id) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == id) return &check;
  }
  return nullptr;
}

TEST(JoinStations, AuditNamesANestThatMovedBetweenTheStations) {
  campaign::Campaign day = simulation::simulate(carriedDay(7200, 1.0));
  const audit::AuditReport good = audit::audit(day);
  const preparation::AuditCheck* agree = checkOf(good, "stations_agree");
  ASSERT_NE(agree, nullptr);
  EXPECT_EQ(agree->verdict, preparation::AuditVerdict::pass);
  EXPECT_NE(reports::words(agree->details.at(0)).find("station 'B', by 5 nests in common"), std::string::npos);
  for (campaign::NestReading& row : day.nests->rows) {
    if (row.station == 1 && row.nest == 2) row.point.z() += 0.6e-3;
  }
  const audit::AuditReport report = audit::audit(day);
  agree = checkOf(report, "stations_agree");
  ASSERT_NE(agree, nullptr);
  EXPECT_EQ(agree->verdict, preparation::AuditVerdict::warn);
  const std::string message = reports::words(agree->message);
  EXPECT_NE(message.find("nest N3 as station 'B' read it stands"), std::string::npos) << message;
  EXPECT_EQ(report.of, good.of);
}

TEST(JoinStations, ADayOfOneStationHasNoSuchCheck) {
  const audit::AuditReport report = audit::audit(simulation::simulate(cleanDay(7300, 1.0)));
  EXPECT_EQ(checkOf(report, "stations_agree"), nullptr);
}

TEST(JoinStations, RawReadingsAreJoinedAsTheyWereRead) {
  simulation::SimulationSpec spec = carriedDay(43, kExact);
  spec.station.ramp[0] = 2e-8;
  const preparation::PreparedCampaign raw = preparation::leaveRaw(simulation::simulate(spec));
  ASSERT_TRUE(raw.preparation.stations);
  EXPECT_FALSE(raw.preparation.drift.taken_off);
  // Prepared once more, the readings stay in the first station's frame.
  const preparation::PreparedCampaign again = preparation::prepareCampaign(raw.campaign);
  const Eigen::Isometry3d once_more = again.preparation.stations->network.stations[1].first_from_station;
  EXPECT_LT((once_more.translation() - Eigen::Vector3d::Zero()).norm(), 1e-3);
}

TEST(JoinStations, RefusesAStationWithTooFewCommonNests) {
  campaign::Campaign day = simulation::simulate(carriedDay(44, 1.0));
  day.folder = "day";
  std::erase_if(day.nests->rows, [](const auto& row) { return row.station == 1 && row.nest > 1; });
  const std::string message = refusalOf(day);
  EXPECT_NE(message.find("nests.csv:"), std::string::npos) << message;
  EXPECT_NE(message.find("station: 'B': expected at least three nests, not on one line, that station 'B' shares with "
                         "station 'A'; it shares 2"),
            std::string::npos)
      << message;
}

TEST(JoinStations, RefusesAStationWithoutNests) {
  campaign::Campaign day = simulation::simulate(carriedDay(45, 1.0));
  std::erase_if(day.nests->rows, [](const auto& row) { return row.station == 1; });
  const std::string message = refusalOf(day);
  EXPECT_NE(message.find("loading.csv:"), std::string::npos) << message;
  EXPECT_NE(message.find("it shares 0"), std::string::npos) << message;
}

TEST(JoinStations, RefusesStationsWithoutTheTrackersNoise) {
  campaign::Campaign day = simulation::simulate(carriedDay(46, 1.0));
  day.tracker.reset();
  EXPECT_NE(refusalOf(day).find("expected a tracker with its noise"), std::string::npos);
}

}  // namespace join_stations_test
}  // namespace stiffscope
