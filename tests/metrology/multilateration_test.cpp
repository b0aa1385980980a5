#include "metrology/multilateration.h"

#include <gtest/gtest.h>

#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace {

const Eigen::Vector3d kTruth(1.0, 2.0, 3.0);

std::vector<metrology::MeasuredDistance> distancesFrom(const std::vector<Eigen::Vector3d>& points,
                                            const Eigen::Vector3d& truth) {
  std::vector<metrology::MeasuredDistance> distances;
  for (const Eigen::Vector3d& point : points) distances.push_back({point, (point - truth).norm()});
  return distances;
}

const std::vector<Eigen::Vector3d> kCorners{{0, 0, 0}, {4, 0, 0}, {0, 5, 0}, {0, 0, 6}, {4, 5, 1}};

void expectRefused(const metrology::Multilateration& found, const std::string& word) {
  EXPECT_FALSE(found.determined);
  EXPECT_NE(found.reason.find(word), std::string::npos) << found.reason;
  EXPECT_TRUE(found.point.allFinite() && found.covariance.allFinite());
}

TEST(Multilaterate, FiveExactDistances) {
  const metrology::Multilateration found = metrology::multilaterate(distancesFrom(kCorners, kTruth));
  ASSERT_TRUE(found.determined) << found.reason;
  EXPECT_LT((found.point - kTruth).norm(), 1e-14);  // rounding of numbers of 6
  EXPECT_FALSE(found.mirror);
  EXPECT_EQ(found.degrees_of_freedom, 2);
}

TEST(Multilaterate, ThreeDistancesHaveTwoPlacesOfWhichTheExpectedIsTaken) {
  auto distances = distancesFrom({kCorners.begin(), kCorners.begin() + 3}, kTruth);
  for (metrology::MeasuredDistance& one : distances) one.sd = 1e-5;
  expectRefused(metrology::multilaterate(distances), "two places");
  const metrology::Multilateration above = metrology::multilaterate(distances, Eigen::Vector3d(0, 0, 1));
  ASSERT_TRUE(above.determined && above.mirror) << above.reason;
  EXPECT_LT((above.point - kTruth).norm(), 1e-13);
  EXPECT_LT((*above.mirror - Eigen::Vector3d(1, 2, -3)).norm(), 1e-13);
  const metrology::Multilateration below = metrology::multilaterate(distances, Eigen::Vector3d(0, 0, -1));
  EXPECT_LT((below.point - Eigen::Vector3d(1, 2, -3)).norm(), 1e-13);
  for (metrology::MeasuredDistance& one : distances) one.sd = 0.0;
  expectRefused(metrology::multilaterate(distances, kTruth), "uncertainty");
}

TEST(Multilaterate, AFourthPointOffThePlaneChoosesTheSide) {
  // Far from the origin and with the closed form's triangle made of the first three.
  auto points = kCorners;
  points.resize(4);
  for (Eigen::Vector3d& point : points) point += Eigen::Vector3d(1e5, -2e5, 0);
  const Eigen::Vector3d truth = kTruth + Eigen::Vector3d(1e5, -2e5, 0);
  const metrology::Multilateration found = metrology::multilaterate(distancesFrom(points, truth));
  ASSERT_TRUE(found.determined) << found.reason;
  EXPECT_LT((found.point - truth).norm(), 1e-10);  // roundings of 2e5
}

TEST(Multilaterate, StatedRegionHoldsTheTruth) {
  // 95 % ellipsoids of 2000 draws: 0.5 % standard error, and about 1.5 % more from the factor that only
  // widens.
  Noise noise(31);
  int inside = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<metrology::MeasuredDistance> distances;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d point(4.0 * noise.uniform(), 5.0 * noise.uniform(), 6.0 * noise.uniform());
      const Eigen::Matrix3d covariance = seenFromOrigin(point + Eigen::Vector3d(1, 1, 1), 6e-6, 2.5e-5);
      distances.push_back({point + noise.draw(covariance), (point - kTruth).norm() + 1e-5 * noise.normal(),
                           covariance, 1e-5});
    }
    const metrology::Multilateration found = metrology::multilaterate(distances);
    ASSERT_TRUE(found.determined) << found.reason;
    const Eigen::Vector3d error = found.point - kTruth;
    inside += error.dot(found.covariance.ldlt().solve(error)) < 7.8147;
  }
  EXPECT_GT(inside, 1860);
  EXPECT_LT(inside, 1940);
}

TEST(Multilaterate, RefusesWhatDeterminesNoPlace) {
  expectRefused(metrology::multilaterate({}), "three");
  expectRefused(metrology::multilaterate(distancesFrom({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}, kTruth)),
                "one line");
  auto distances = distancesFrom(kCorners, kTruth);
  distances[2].distance = std::nan("");
  expectRefused(metrology::multilaterate(distances), "finite");
  // In the plane of all points the height across it is free to first order.
  expectRefused(metrology::multilaterate(distancesFrom({{0, 0, 0}, {4, 0, 0}, {0, 5, 0}, {4, 5, 0}}, {1, 2, 0})), "plane");
}

TEST(Multilaterate, PublishedTwoRoots) {
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  const auto& one = (*file)["trilateration_two_roots_7"];
  std::vector<metrology::MeasuredDistance> distances;
  for (std::size_t i = 0; i < 3; ++i) {
    distances.push_back(
        {vector(one["anchors"][i]), one["distances"][i].get<double>(), Eigen::Matrix3d::Zero(), 1e-4});
  }
  for (const auto& exact : one["exact_roots"]) {
    const metrology::Multilateration found = metrology::multilaterate(distances, vector(exact));
    ASSERT_TRUE(found.determined) << found.reason;
    EXPECT_LT((found.point - vector(exact)).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace stiffscope
