#include "metrology/sphere_fit.h"

#include <gtest/gtest.h>

#include "reports/words/remark_words.h"
#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace sphere_fit_test {

const Eigen::Vector3d kCentre(2.1, -1.3, 0.8);

metrology::SpherePoints cap(double radius, double half_angle_deg, int count, std::uint64_t seed) {
  Noise noise(seed);
  metrology::SpherePoints sphere;
  while (static_cast<int>(sphere.points.size()) < count) {
    const Eigen::Vector3d outward = noise.direction();
    if (outward.z() > std::cos(radians(half_angle_deg))) sphere.points.push_back(kCentre + radius * outward);
  }
  return sphere;
}

void expectRefused(const std::vector<metrology::SpherePoints>& spheres, const std::string& word) {
  const metrology::SphereFit fit = metrology::fitSpheres(spheres);
  EXPECT_FALSE(fit.determined);
  EXPECT_NE(reports::words(fit.reason).find(word), std::string::npos) << reports::words(fit.reason);
  EXPECT_TRUE(fit.centre.allFinite());
}

TEST(FitSpheres, OneSphereByHand) {
  // The six ends of the coordinate axes of a sphere of radius 2 about (1, 2, 3).
  const metrology::SphereFit fit =
      metrology::fitSpheres({{{{3, 2, 3}, {-1, 2, 3}, {1, 4, 3}, {1, 0, 3}, {1, 2, 5}, {1, 2, 1}}, {}}});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT((fit.centre - Eigen::Vector3d(1, 2, 3)).norm(), 1e-14);
  EXPECT_NEAR(fit.radii[0], 2.0, 1e-14);
  EXPECT_EQ(fit.degrees_of_freedom, 2);
}

TEST(FitSpheres, ExactConcentricSpheres) {
  for (const double half_angle : {10.0, 60.0, 180.0}) {
    const metrology::SphereFit fit =
        metrology::fitSpheres({cap(0.55, half_angle, 12, 1), cap(0.6, half_angle, 9, 2), cap(0.3, half_angle, 7, 3)});
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    EXPECT_LT((fit.centre - kCentre).norm(), 1e-12) << half_angle;  // rounding over a cap of 1.5 % height
    EXPECT_NEAR(fit.radii[0], 0.55, 1e-12);
    EXPECT_NEAR(fit.radii[1], 0.6, 1e-12);
    EXPECT_NEAR(fit.radii[2], 0.3, 1e-12);
  }
}

TEST(FitSpheres, ACommonCentreNeedsNoSphereToBeWhole) {
  // Each reflector in a plane of its own, but not the same: together they have a centre.
  metrology::SpherePoints flat_x, flat_y;
  for (int i = 0; i < 8; ++i) {
    flat_x.points.push_back(onCircle(kCentre, Eigen::Vector3d::UnitX(), 0.5, 0.2, radians(40.0 * i)));
    flat_y.points.push_back(onCircle(kCentre, Eigen::Vector3d::UnitY(), 0.4, -0.1, radians(40.0 * i)));
  }
  const metrology::SphereFit fit = metrology::fitSpheres({flat_x, flat_y});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT((fit.centre - kCentre).norm(), 1e-12);
}

TEST(FitSpheres, RefusesWhatDeterminesNoCentre) {
  metrology::SpherePoints flat, place;
  for (int i = 0; i < 8; ++i) {
    flat.points.push_back(onCircle(kCentre, Eigen::Vector3d(1, 2, 2) / 3.0, 0.5, 0.2, radians(40.0 * i)));
    place.points.push_back(kCentre);
  }
  expectRefused({}, "no readings");
  expectRefused({metrology::SpherePoints{}}, "four");
  expectRefused({cap(0.5, 60, 3, 1)}, "four");
  expectRefused({cap(0.5, 60, 10, 1), cap(0.5, 60, 3, 2)}, "four");
  expectRefused({flat}, "plane");
  expectRefused({place}, "one place");
}

TEST(FitSpheres, FourPointsLeaveNothingToTellTheUncertaintyBy) {
  // Four points always fit: without covariances that must not read as an exact centre.
  metrology::SpherePoints sphere = cap(0.5, 60, 4, 5);
  expectRefused({sphere}, "too few");
  sphere.covariances.assign(4, 1e-10 * Eigen::Matrix3d::Identity());
  const metrology::SphereFit weighted = metrology::fitSpheres({sphere});
  ASSERT_TRUE(weighted.determined) << reports::words(weighted.reason);
  const Eigen::Matrix3d covariance = weighted.covariance.topLeftCorner(3, 3);
  EXPECT_GT(covariance.trace(), 1e-10);  // no better than one coordinate of one reading
}

TEST(FitSpheres, WeightsPullTowardsThePrecisePoints) {
  metrology::SpherePoints sphere = cap(0.5, 120, 15, 4);
  sphere.points[7] += 1e-3 * (sphere.points[7] - kCentre).normalized();
  sphere.covariances.assign(15, 1e-10 * Eigen::Matrix3d::Identity());
  EXPECT_GT((metrology::fitSpheres({sphere}).centre - kCentre).norm(), 1e-5);
  sphere.covariances[7] *= 1e8;
  EXPECT_LT((metrology::fitSpheres({sphere}).centre - kCentre).norm(), 1e-10);  // 1 mm by a weight of 1e-8
}

TEST(FitSpheres, NistReferenceSpheres) {
  // NIST's algorithm testing pairs; .fit holds centre and diameter of the least-squares sphere.
  const auto folder = referenceFolder() / "nist" / "Sphere";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "reference data are not beside the checkout";
  int pairs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".ds") continue;
    std::ifstream data(entry.path()), answer(std::filesystem::path(entry.path()).replace_extension(".fit"));
    std::size_t count = 0;
    data >> count;
    metrology::SpherePoints sphere;
    for (double x, y, z; data >> x >> y >> z;) sphere.points.push_back({x, y, z});
    ASSERT_EQ(sphere.points.size(), count);
    // Equal weights: the same least squares, and an uncertainty for the pair that has only four points.
    sphere.covariances.assign(count, Eigen::Matrix3d::Identity());
    Eigen::Vector3d centre;
    double diameter = 0.0;
    answer >> centre.x() >> centre.y() >> centre.z() >> diameter;
    const metrology::SphereFit fit = metrology::fitSpheres({sphere});
    ASSERT_TRUE(fit.determined) << entry.path() << reports::words(fit.reason);
    // NIST's own answers hold to about 1e-11 of the size; parts of a sphere lose two to three digits of that.
    EXPECT_LT((fit.centre - centre).norm(), 1e-8 * diameter) << entry.path();
    EXPECT_NEAR(2.0 * fit.radii[0], diameter, 1e-8 * diameter) << entry.path();
    ++pairs;
  }
  EXPECT_GT(pairs, 5);
}

}  // namespace sphere_fit_test
}  // namespace stiffscope
