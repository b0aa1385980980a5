#include "core/preparation/station_network.h"

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "metrology/registration.h"
#include "tests/metrology/simulated_points.h"

// Stations that read nests, made here: poses, places and noise of their own.

namespace stiffscope {
namespace station_network_test {

using Joined = preparation::StationPose::Joined;

const Eigen::Vector3d kArm{2.0, 1.0, 0.5};
const std::vector<Eigen::Vector3d> kPlaces{
    {0.5, 2.5, -1.2}, {3.8, 2.2, -1.1}, {4.1, -1.0, -1.2}, {1.0, -1.6, 0.9}, {2.4, 3.4, 1.4}};

/// The second tracker on the other side of the arm, turned by 160 deg.
Eigen::Isometry3d otherSide() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(radians(160.0), Eigen::Vector3d(0.05, -0.02, 1.0).normalized())).matrix();
  pose.translation() = Eigen::Vector3d(5.5, 1.5, 0.2);
  return pose;
}

struct HowRead {
  double along = 5e-6, across = 20e-6;  ///< m
  int rounds = 2;
  Noise* noise = nullptr;  ///< none: exact
};

/// What a station at first_from_station reads of these nests; lines count on from `line`.
preparation::NestsOfStation readingsOf(const Eigen::Isometry3d& first_from_station, const std::vector<int>& nests,
                                       const HowRead& setup, std::size_t& line) {
  preparation::NestsOfStation station;
  station.noise = {setup.along, 0.0, setup.across, 0.0, Eigen::Vector3d::Zero()};
  for (int round = 0; round < setup.rounds; ++round) {
    for (const int nest : nests) {
      campaign::NestReading reading;
      reading.nest = nest;
      reading.time_s = static_cast<double>(line);
      reading.point = first_from_station.inverse() * kPlaces[static_cast<std::size_t>(nest)];
      if (setup.noise != nullptr)
        reading.point += setup.noise->draw(seenFromOrigin(reading.point, setup.along, setup.across));
      reading.line = line++;
      station.readings.push_back(reading);
    }
  }
  return station;
}

std::vector<preparation::NestsOfStation> twoStations(const HowRead& setup) {
  std::size_t line = 2;
  std::vector<preparation::NestsOfStation> stations;
  stations.push_back(readingsOf(Eigen::Isometry3d::Identity(), {0, 1, 2, 3, 4}, setup, line));
  stations.push_back(readingsOf(otherSide(), {0, 1, 2, 3, 4}, setup, line));
  return stations;
}

/// Rotation vector and displacement at the arm by which a pose is off.
Eigen::Matrix<double, 6, 1> offBy(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d off = pose * truth.inverse();
  const Eigen::AngleAxisd turn(off.linear());
  Eigen::Matrix<double, 6, 1> result;
  result << turn.angle() * turn.axis(), off * kArm - kArm;
  return result;
}

TEST(StationNetwork, ExactReadingsGiveTheMotionThatWasPutIn) {
  const preparation::StationNetwork network = preparation::fitStationNetwork(twoStations({}), kArm);
  ASSERT_TRUE(network.allJoined());
  EXPECT_EQ(network.stations[1].common_nests, 5);
  // Rounding of coordinates of some metres: 1e-15 of 5 m, and some more through the normal equations.
  EXPECT_LT(offBy(network.stations[1].first_from_station, otherSide()).norm(), 1e-12);
  EXPECT_TRUE(network.stations[0].first_from_station.matrix().isIdentity(0.0));
  EXPECT_TRUE(network.stations[0].covariance.isZero(0.0));
  EXPECT_EQ(network.dof, 3 * 20 - 6 - 3 * 5);
  EXPECT_LT(network.chi2, 1e-6);
  EXPECT_TRUE(network.consistent());
  EXPECT_TRUE(network.outlying.empty());
}

// Each nest read once from either side: its place goes out of the normal equations and leaves the difference of the
// two readings, weighted by the sum of their covariances - a rigid registration by code of another library.
TEST(StationNetwork, OneReadingEachIsTheWeightedRigidRegistration) {
  Noise noise(27401);
  HowRead setup;
  setup.rounds = 1;
  setup.noise = &noise;
  const auto stations = twoStations(setup);
  const preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  ASSERT_TRUE(network.allJoined());
  std::vector<Eigen::Vector3d> own, first;
  std::vector<Eigen::Matrix3d> covariances;
  const Eigen::Matrix3d turn = network.stations[1].first_from_station.linear();
  for (std::size_t k = 0; k < kPlaces.size(); ++k) {
    own.push_back(stations[1].readings[k].point);
    first.push_back(stations[0].readings[k].point);
    covariances.push_back(seenFromOrigin(first.back(), setup.along, setup.across) +
                          turn * seenFromOrigin(own.back(), setup.along, setup.across) * turn.transpose());
  }
  const metrology::WeightedRegistration other = metrology::registerRigid(own, first, covariances);
  ASSERT_TRUE(other.determined);
  // Both stop where a step is a thousandth of the noise or less; 1 % of the noise of one reading across the beam.
  EXPECT_LT(offBy(network.stations[1].first_from_station, other.to_from_source).norm(), 2e-7);
  EXPECT_EQ(network.dof, other.degrees_of_freedom);
  EXPECT_NEAR(network.chi2, other.chi2_per_dof * other.degrees_of_freedom, 0.02 * network.chi2);
  // The other's covariance is scaled by chi2 per degree of freedom where that is above 1, its turn is about its pivot.
  const double scale = std::max(1.0, other.chi2_per_dof);
  Eigen::Matrix<double, 6, 6> to_arm = Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::Vector3d lever = kArm - other.pivot;
  to_arm.block<3, 3>(3, 0) << 0, lever.z(), -lever.y(), -lever.z(), 0, lever.x(), lever.y(), -lever.x(), 0;
  const Eigen::Matrix<double, 6, 6> expected = to_arm * other.covariance * to_arm.transpose() / scale;
  EXPECT_LT((network.stations[1].covariance - expected).norm(), 1e-3 * expected.norm());
}

// 95 % regions of the pose over fresh days hold the truth in 95 %: 600 days, three binomial deviations. The network's
// chi2 is that of its degrees of freedom on average.
TEST(StationNetwork, CovarianceHoldsTheTruthAsOftenAsItSays) {
  constexpr int kDays = 600;
  const double limit_6 = quantile(boost::math::chi_squared(6.0), 0.95);
  const double limit_3 = quantile(boost::math::chi_squared(3.0), 0.95);
  const Eigen::Vector3d far{-1.0, 3.0, 2.0};  // a reading away from the centre
  int pose_held = 0, point_held = 0, judged = 0;
  double chi2 = 0.0;
  int dof = 0;
  for (int day = 0; day < kDays; ++day) {
    Noise noise(9'417'000 + static_cast<std::uint64_t>(day));
    HowRead setup;
    setup.noise = &noise;
    const preparation::StationNetwork network = preparation::fitStationNetwork(twoStations(setup), kArm);
    ASSERT_TRUE(network.allJoined());
    const preparation::StationPose& pose = network.stations[1];
    const Eigen::Matrix<double, 6, 1> off = offBy(pose.first_from_station, otherSide());
    pose_held += off.dot(pose.covariance.ldlt().solve(off)) <= limit_6;
    const Eigen::Vector3d moved = pose.first_from_station * (otherSide().inverse() * far) - far;
    point_held += moved.dot(pose.covarianceAt(far).ldlt().solve(moved)) <= limit_3;
    judged += !network.consistent();
    chi2 += network.chi2;
    dof += network.dof;
  }
  const double three_deviations = 3.0 * std::sqrt(0.95 * 0.05 / kDays);
  RecordProperty("pose_held_percent", std::to_string(100.0 * pose_held / kDays));
  RecordProperty("point_held_percent", std::to_string(100.0 * point_held / kDays));
  RecordProperty("chi2_per_dof", std::to_string(chi2 / dof));
  EXPECT_NEAR(static_cast<double>(pose_held) / kDays, 0.95, three_deviations);
  EXPECT_NEAR(static_cast<double>(point_held) / kDays, 0.95, three_deviations);
  // A variance of 2 a degree of freedom, so many of them.
  EXPECT_NEAR(chi2 / dof, 1.0, 3.0 * std::sqrt(2.0 / dof));
  EXPECT_EQ(judged, 0);  // one day in 3000 by the level
}

TEST(StationNetwork, NamesANestThatMovedBetweenTheStationsAndGoesByTheOthers) {
  Noise noise(27403);
  HowRead setup;
  setup.noise = &noise;
  auto stations = twoStations(setup);
  const Eigen::Vector3d shift{0.0, 0.0, 0.4e-3};
  for (campaign::NestReading& reading : stations[1].readings) {
    if (reading.nest == 3) reading.point += otherSide().linear().transpose() * shift;
  }
  const preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  ASSERT_EQ(network.outlying.size(), 1u);
  EXPECT_EQ(network.outlying[0].nest, 3);
  EXPECT_EQ(network.outlying[0].station, 1u);
  EXPECT_FALSE(network.outlying[0].line);
  EXPECT_NEAR(network.outlying[0].by, shift.norm(), 0.1e-3);  // four readings of 20 um across, and the pose
  EXPECT_TRUE(network.consistent());
  const auto off = offBy(network.stations[1].first_from_station, otherSide());
  EXPECT_LT(off.dot(network.stations[1].covariance.ldlt().solve(off)), quantile(boost::math::chi_squared(6.0), 0.9999));
}

TEST(StationNetwork, ThreeStationsTellWhichOfThemReadTheNestElsewhere) {
  Noise noise(27404);
  HowRead setup;
  setup.noise = &noise;
  auto stations = twoStations(setup);
  std::size_t line = 100;
  Eigen::Isometry3d third = Eigen::Isometry3d::Identity();
  third.linear() = Eigen::AngleAxisd(radians(-70.0), Eigen::Vector3d::UnitZ()).matrix();
  third.translation() = Eigen::Vector3d(0.5, 5.0, 0.0);
  stations.push_back(readingsOf(third, {0, 1, 2, 3, 4}, setup, line));
  for (campaign::NestReading& reading : stations[1].readings) {
    if (reading.nest == 2) reading.point.x() += 1e-3;
  }
  const preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  ASSERT_EQ(network.outlying.size(), 1u);
  EXPECT_EQ(network.outlying[0].nest, 2);
  EXPECT_EQ(network.outlying[0].station, 1u);
}

TEST(StationNetwork, NamesASingleWrongReadingByItsLine) {
  Noise noise(27405);
  HowRead setup;
  setup.noise = &noise;
  setup.rounds = 3;
  auto stations = twoStations(setup);
  campaign::NestReading& wrong = stations[1].readings[7];
  wrong.point.y() += 2e-3;
  const preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  ASSERT_EQ(network.outlying.size(), 1u);
  ASSERT_TRUE(network.outlying[0].line);
  EXPECT_EQ(*network.outlying[0].line, wrong.line);
  EXPECT_EQ(network.outlying[0].nest, wrong.nest);
  EXPECT_NEAR(network.outlying[0].by, 2e-3, 0.15e-3);
}

TEST(StationNetwork, SaysWhyAStationIsNotJoined) {
  std::size_t line = 2;
  std::vector<preparation::NestsOfStation> stations;
  stations.push_back(readingsOf(Eigen::Isometry3d::Identity(), {0, 1, 2, 3}, {}, line));
  stations.push_back(readingsOf(otherSide(), {0, 1, 4}, {}, line));
  preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  EXPECT_FALSE(network.allJoined());
  EXPECT_EQ(network.stations[1].joined, Joined::too_few_common_nests);
  EXPECT_EQ(network.stations[1].common_nests, 2);

  // Three nests in one line: the turn about it is open.
  for (auto& station : stations) station.readings.clear();
  for (int nest = 0; nest < 3; ++nest) {
    const Eigen::Vector3d place{1.0 + nest, 2.0 + 0.5 * nest, -1.0};
    for (std::size_t s = 0; s < 2; ++s) {
      campaign::NestReading reading;
      reading.nest = nest;
      reading.point = s == 0 ? place : otherSide().inverse() * place;
      stations[s].readings.push_back(reading);
    }
  }
  network = preparation::fitStationNetwork(stations, kArm);
  EXPECT_EQ(network.stations[1].joined, Joined::common_nests_on_one_line);
  EXPECT_EQ(network.stations[1].common_nests, 3);
}

// The third has nothing in common with the first but two nests; with the second it has three.
TEST(StationNetwork, JoinsAStationThroughAnother) {
  std::size_t line = 2;
  Eigen::Isometry3d third = Eigen::Isometry3d::Identity();
  third.linear() = Eigen::AngleAxisd(radians(100.0), Eigen::Vector3d(0.3, 1.0, 2.0).normalized()).matrix();
  third.translation() = Eigen::Vector3d(7.0, -2.0, 0.4);
  std::vector<preparation::NestsOfStation> stations;
  stations.push_back(readingsOf(Eigen::Isometry3d::Identity(), {0, 1, 2}, {}, line));
  stations.push_back(readingsOf(third, {2, 3, 4}, {}, line));
  stations.push_back(readingsOf(otherSide(), {0, 1, 2, 3, 4}, {}, line));
  const preparation::StationNetwork network = preparation::fitStationNetwork(stations, kArm);
  ASSERT_TRUE(network.allJoined());
  EXPECT_LT(offBy(network.stations[1].first_from_station, third).norm(), 1e-11);
  EXPECT_LT(offBy(network.stations[2].first_from_station, otherSide()).norm(), 1e-11);
  // What is joined through another is known less well than that.
  EXPECT_GT(network.stations[1].covariance.trace(), network.stations[2].covariance.trace());
}

}  // namespace station_network_test
}  // namespace stiffscope
