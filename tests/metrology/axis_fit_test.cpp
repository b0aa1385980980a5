#include "metrology/axis_fit.h"

#include <gtest/gtest.h>
#include "metrology/lines.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace axis_fit_test {

const Eigen::Vector3d kCentre(2.1, -1.3, 0.8);
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();

metrology::CirclePoints arc(double radius, double height, double from, double degrees, int stops) {
  metrology::CirclePoints circle;
  for (int i = 0; i < stops; ++i) {
    circle.points.push_back(onCircle(kCentre, kAxis, radius, height, from + radians(degrees) * i / (stops - 1)));
  }
  return circle;
}

double missOfCentre(const metrology::AxisFit& fit) {
  return (metrology::nearestPoint(fit.axis.line, kCentre) - kCentre).norm();
}

void expectFinite(const metrology::AxisFit& fit) {
  EXPECT_TRUE(fit.axis.line.point.allFinite());
  EXPECT_TRUE(fit.axis.line.direction.allFinite());
  EXPECT_TRUE(fit.axis.covariance.allFinite());
  EXPECT_TRUE(std::isfinite(fit.rms) && std::isfinite(fit.chi2_per_dof));
  for (const metrology::AxisCircle& circle : fit.circles)
    EXPECT_TRUE(std::isfinite(circle.radius + circle.height + circle.rms));
}

void expectRefused(const std::vector<metrology::CirclePoints>& circles, const std::string& word) {
  const metrology::AxisFit fit = metrology::fitAxis(circles);
  EXPECT_FALSE(fit.determined);
  EXPECT_NE(reports::words(fit.reason).find(word), std::string::npos) << reports::words(fit.reason);
  expectFinite(fit);
}

TEST(FitAxis, OneCircleByHand) {
  // Radius 5 about z at height 1, centre (1, 2): 3-4-5 triangles.
  const metrology::CirclePoints circle{{{6, 2, 1}, {4, 6, 1}, {1, 7, 1}, {-3, 5, 1}, {-4, 2, 1}, {1, -3, 1}}, {}};
  const metrology::AxisFit fit = metrology::fitAxis({circle});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_NEAR(std::abs(fit.axis.line.direction.z()), 1.0, 1e-14);
  const Eigen::Vector3d foot = metrology::nearestPoint(fit.axis.line, {1, 2, 1});
  EXPECT_LT((foot - Eigen::Vector3d(1, 2, 1)).norm(), 1e-13);  // rounding of numbers of 10
  EXPECT_NEAR(fit.circles[0].radius, 5.0, 1e-13);
  EXPECT_EQ(fit.degrees_of_freedom, 12 - 6);
  EXPECT_LT(fit.rms, 1e-13);
}

TEST(FitAxis, ExactCirclesOfThreeReflectors) {
  for (const double degrees : {10.0, 40.0, 90.0, 280.0}) {
    const metrology::AxisFit fit = metrology::fitAxis(
        {arc(1.9, 0.3, 0.2, degrees, 9), arc(2.3, -0.1, 0.5, degrees, 9), arc(0.4, 0.0, 2.0, degrees, 9)});
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    // Rounding (4e-16 of 4 m) grows with the inverse of the sagitta, 0.4 % of the radius at 10 degrees, and
    // its square.
    const double tolerance = degrees < 20.0 ? 1e-10 : 1e-12;
    EXPECT_LT(missOfCentre(fit), tolerance) << degrees;
    EXPECT_LT(fit.axis.line.direction.cross(kAxis).norm(), tolerance) << degrees;
    const std::array<double, 3> radii{1.9, 2.3, 0.4};
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(fit.circles[k].radius, radii[k], tolerance);
      EXPECT_NEAR(fit.circles[k].arc, radians(degrees), 1e-9);
    }
    const double sense = fit.axis.line.direction.dot(kAxis) < 0.0 ? -1.0 : 1.0;
    EXPECT_NEAR(sense * (fit.circles[0].height - fit.circles[1].height), 0.4, tolerance);
  }
}

TEST(FitAxis, AnisotropicWeightsDoNotMoveAnExactFitAndAgreeWhereTheyAreEqual) {
  std::vector<metrology::CirclePoints> circles{arc(1.9, 0.3, 0.2, 90, 9), arc(2.3, -0.1, 0.5, 90, 9)};
  Noise noise(3);
  std::vector<metrology::CirclePoints> disturbed = circles;
  for (metrology::CirclePoints& circle : disturbed) {
    for (Eigen::Vector3d& point : circle.points) point += 2e-5 * noise.normal3();
  }
  const metrology::AxisFit plain = metrology::fitAxis(disturbed);
  for (metrology::CirclePoints& circle : disturbed) circle.covariances.assign(9, 4e-10 * Eigen::Matrix3d::Identity());
  const metrology::AxisFit equal = metrology::fitAxis(disturbed);
  // The same least squares: differences are those of stopping at steps of 1e-12.
  EXPECT_LT((plain.axis.line.direction - equal.axis.line.direction).norm(), 1e-11);
  EXPECT_LT(
      (metrology::nearestPoint(plain.axis.line, kCentre) - metrology::nearestPoint(equal.axis.line, kCentre)).norm(),
      1e-11);
  EXPECT_GT(equal.chi2_per_dof,
            0.3);  // 24 degrees of freedom: 0.3 to 2.2 holds but for one seed in a thousand
  EXPECT_LT(equal.chi2_per_dof, 2.2);

  for (metrology::CirclePoints& circle : circles) {
    for (const Eigen::Vector3d& point : circle.points) circle.covariances.push_back(seenFromOrigin(point, 5e-6, 5e-5));
  }
  const metrology::AxisFit weighted = metrology::fitAxis(circles);
  ASSERT_TRUE(weighted.determined);
  EXPECT_LT(missOfCentre(weighted), 1e-11);
  EXPECT_LT(weighted.axis.line.direction.cross(kAxis).norm(), 1e-11);
}

TEST(FitAxis, WeightsPullTowardsThePrecisePoints) {
  // Nine points on the circle; one displaced by 1 mm outwards, declared ten thousand times worse.
  metrology::CirclePoints circle = arc(1.0, 0.0, 0.0, 300, 9);
  circle.points[4] += 1e-3 * (circle.points[4] - kCentre).normalized();
  circle.covariances.assign(9, 1e-10 * Eigen::Matrix3d::Identity());
  const metrology::AxisFit trusting = metrology::fitAxis({circle});
  circle.covariances[4] *= 1e8;
  const metrology::AxisFit warned = metrology::fitAxis({circle});
  EXPECT_GT(missOfCentre(trusting), 1e-4);
  EXPECT_LT(missOfCentre(warned), 1e-10);  // 1 mm by a weight of 1e-8, shared among nine
}

TEST(FitAxis, AReflectorOnTheAxisSaysNothingAndHarmsNothing) {
  metrology::CirclePoints on_axis;
  for (int i = 0; i < 9; ++i) on_axis.points.push_back(kCentre + 0.2 * kAxis);
  const metrology::AxisFit fit = metrology::fitAxis({arc(1.9, 0.3, 0.2, 90, 9), on_axis});
  expectFinite(fit);
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  // The radius of a circle of no size makes the outward direction arbitrary; the exact answer still fits
  // exactly.
  EXPECT_LT(missOfCentre(fit), 1e-9);
  EXPECT_LT(fit.axis.line.direction.cross(kAxis).norm(), 1e-9);
  EXPECT_NEAR(fit.circles[1].radius, 0.0, 1e-9);
}

TEST(FitAxis, AReflectorNearTheAxisWithNoise) {
  // A radius of 50 um with noise of 20 um: its direction is noise, the other two circles carry the axis.
  Noise noise(8);
  std::vector<metrology::CirclePoints> circles{arc(0.5, 0.3, 0.2, 180, 13), arc(0.4, -0.1, 0.5, 180, 13),
                                               arc(5e-5, 0.1, 0.0, 180, 13)};
  for (metrology::CirclePoints& circle : circles) {
    for (Eigen::Vector3d& point : circle.points) point += 2e-5 * noise.normal3();
  }
  const metrology::AxisFit fit = metrology::fitAxis(circles);
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  expectFinite(fit);
  EXPECT_LT(missOfCentre(fit), 6e-5);  // 20 um over 26 points, some eightfold by the half turn
}

TEST(FitAxis, RefusesWhatDetermineNoAxis) {
  metrology::CirclePoints line, place, two;
  for (int i = 0; i < 6; ++i) {
    line.points.push_back(Eigen::Vector3d(1, 2, 3) + i * Eigen::Vector3d(0.1, 0.2, -0.05));
    place.points.push_back({1, 2, 3});
  }
  two.points = {{1, 0, 0}, {0, 1, 0}};
  expectRefused({}, "three readings");
  expectRefused({metrology::CirclePoints{}}, "three readings");
  expectRefused({two}, "three readings");
  expectRefused({two, two, two}, "three readings");
  expectRefused({line}, "one line");
  expectRefused({place}, "one place");
  expectRefused({place, place}, "one place");
  // Three points always fit a circle: nothing is left to tell its uncertainty.
  expectRefused({metrology::CirclePoints{{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}}}, "too few");
  // Three readings that repeat two places.
  expectRefused({metrology::CirclePoints{{{1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}}, {}}}, "one line");
}

TEST(FitAxis, ThreePlacesReadAgainAndAgain) {
  // Three stops read five times each: exact and determined, as three points are.
  metrology::CirclePoints circle;
  for (int i = 0; i < 15; ++i) circle.points.push_back(onCircle(kCentre, kAxis, 1.2, 0.1, radians(60.0) * (i % 3)));
  const metrology::AxisFit fit = metrology::fitAxis({circle});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT(missOfCentre(fit), 1e-12);
}

TEST(FitAxis, ACircleThatWasHardlyReadJoinsIn) {
  // A reflector lost after one or two readings has no circle of its own, but does not spoil those of the
  // others.
  metrology::CirclePoints lost = arc(1.1, 0.2, 0.0, 20, 2), once = arc(0.9, 0.4, 0.0, 20, 2), never;
  once.points.resize(1);
  const metrology::AxisFit fit = metrology::fitAxis({arc(1.9, 0.3, 0.2, 90, 9), lost, once});
  expectFinite(fit);
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT(missOfCentre(fit), 1e-11);
  expectRefused({arc(1.9, 0.3, 0.2, 90, 9), never}, "no readings");
}

TEST(FitAxis, NotANumberIsRefused) {
  metrology::CirclePoints circle = arc(1.9, 0.3, 0.2, 90, 9);
  circle.points[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(metrology::fitAxis({circle}).determined);
}

TEST(FitAxis, NplCircleWithItsPublishedCovariance) {
  // NPL's worked example of a 3-D circle by orthogonal distances: same model, published covariance.
  const auto file = reference("npl-circle3d.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  metrology::CirclePoints circle;
  for (const auto& point : (*file)["points"]) circle.points.push_back(vector(point));
  const metrology::AxisFit fit = metrology::fitAxis({circle});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  const auto& published = (*file)["published"];
  const auto& recomputed = (*file)["recomputed_independently"];
  const Eigen::Vector3d axis = fit.axis.line.direction * (fit.axis.line.direction.z() < 0.0 ? -1.0 : 1.0);
  const Eigen::Vector3d centre = fit.axis.line.point + fit.circles[0].height * fit.axis.line.direction;
  EXPECT_LT((centre - vector(recomputed["x0n"])).norm(),
            1e-6);                                            // ten printed decimals, mm; two solvers' stops
  EXPECT_LT((axis - vector(recomputed["an"])).norm(), 1e-9);  // ten printed decimals
  EXPECT_NEAR(fit.circles[0].radius, recomputed["rn"].get<double>(), 1e-6);
  EXPECT_EQ(fit.degrees_of_freedom, 2 * 7 - 6);
  // sigma over degrees of freedom; rms is over the 14 residuals.
  EXPECT_NEAR(fit.rms * std::sqrt(14.0 / 8.0), recomputed["sigmah"].get<double>(), 1e-7);

  // Covariance of the centre across the axis, and of the direction, in the published axes (four digits
  // printed).
  Eigen::Matrix<double, 3, 2> across;
  across << fit.axis.across_u, fit.axis.across_v;
  Eigen::Matrix<double, 2, 4> to_centre;
  to_centre << Eigen::Matrix2d::Identity(), fit.circles[0].height * Eigen::Matrix2d::Identity();
  const Eigen::Matrix3d of_centre =
      across * to_centre * fit.axis.covariance * to_centre.transpose() * across.transpose();
  const Eigen::Matrix3d of_direction = across * fit.axis.covariance.bottomRightCorner<2, 2>() * across.transpose();
  for (int row = 0; row < 2; ++row) {  // the z row of the centre also holds the plane's height: not the line's
    for (int column = 0; column < 2; ++column) {
      EXPECT_NEAR(1e3 * of_centre(row, column),
                  published["Vx0n_1e-3"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>(),
                  6e-5);
      EXPECT_NEAR(1e7 * of_direction(row, column),
                  published["Van_1e-7"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>(),
                  6e-5);
    }
  }
}

TEST(FitAxis, PublishedExactCircles) {
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  for (const auto& one : (*file)["circle3d_exact_pizzamiglio"]["cases"]) {
    metrology::CirclePoints circle;
    for (const auto& point : one["points"]) circle.points.push_back(vector(point));
    if (circle.points.size() < 4) circle.points.insert(circle.points.end(), circle.points.begin(), circle.points.end());
    const metrology::AxisFit fit = metrology::fitAxis({circle});
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    EXPECT_LT((metrology::nearestPoint(fit.axis.line, vector(one["c"])) - vector(one["c"])).norm(), 1e-12);
    // Where the points are not on a circle the entry's note has the geometric radius.
    EXPECT_NEAR(fit.circles[0].radius, one.contains("r") ? one["r"].get<double>() : 1.5, 1e-12);
  }
  metrology::CirclePoints line;
  for (const auto& point : (*file)["circle3d_exact_pizzamiglio"]["must_fail"][0]) line.points.push_back(vector(point));
  EXPECT_FALSE(metrology::fitAxis({line}).determined);
}

}  // namespace axis_fit_test
}  // namespace stiffscope
