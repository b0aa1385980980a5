#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <limits>
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/line_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/remarks.h"
#include "metrology/sphere_fit.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/reference.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace fits_test {

using Points = std::vector<Eigen::Vector3d>;

const Eigen::Vector3d kCentre(2.1, -1.3, 0.8);
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();

TEST(FitPlane, ByHand) {
  // A square at z = 1, its corners lifted and lowered by 0.01 in turn: the plane is z = 1, every residual
  // 0.01.
  const metrology::FittedPlane fit =
      metrology::fitPlane({{{0, 0, 1.01}, {1, 0, 0.99}, {1, 1, 1.01}, {0, 1, 0.99}}, {}});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT((fit.plane.normal - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((fit.plane.point - Eigen::Vector3d(0.5, 0.5, 1.0)).norm(), 1e-15);
  EXPECT_NEAR(fit.rms, 0.01, 1e-15);
  EXPECT_NEAR(fit.residual_sd, 0.02, 1e-15);          // 4 * 0.01^2 over one degree of freedom
  EXPECT_NEAR((*fit.covariance)(2, 2), 1e-4, 1e-17);  // 0.02^2 over four points
  EXPECT_NEAR((*fit.covariance)(3, 3), 4e-4, 1e-17);  // 0.02^2 over sum of (x - 0.5)^2, which is 1
  EXPECT_NEAR((*fit.covariance)(5, 5), 0.0, 1e-17);
}

TEST(FitLine, ByHand) {
  // Along x, off by 0.1 to and fro in y: symmetric about the middle, so the line is y = 0.
  const metrology::FittedLine fit = metrology::fitLine({{{-3, 0.1, 5}, {-1, -0.1, 5}, {1, -0.1, 5}, {3, 0.1, 5}}, {}});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT((fit.line.direction - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((fit.line.point - Eigen::Vector3d(0, 0, 5)).norm(), 1e-15);
  EXPECT_EQ(fit.degrees_of_freedom, 4);
  EXPECT_NEAR(fit.residual_sd, 0.1, 1e-15);  // 4 * 0.01 over 4
  EXPECT_NEAR((*fit.covariance)(1, 1), 0.01 / 4.0, 1e-16);
  EXPECT_NEAR((*fit.covariance)(4, 4), 0.01 / 20.0, 1e-16);
}

TEST(FitCircle, BothStrategiesNameThemselvesAndAgreeOnAFlatCircle) {
  Points points;
  for (int i = 0; i < 9; ++i) points.push_back(onCircle(kCentre, kAxis, 1.2, 0.0, radians(20.0 * i)));
  for (const metrology::CircleStrategy strategy :
       {metrology::CircleStrategy::full, metrology::CircleStrategy::plane_first}) {
    const metrology::FittedCircle fit = metrology::fitCircle({points, {}}, strategy);
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    EXPECT_LT((fit.circle.centre - kCentre).norm(), 1e-15 * 8);  // roundings of the coordinates of the points
    EXPECT_LT((fit.circle.normal - kAxis).norm(), 1e-15 * 8);
    EXPECT_NEAR(fit.circle.radius, 1.2, 1e-15 * 8);
    EXPECT_TRUE(fit.method.is(strategy == metrology::CircleStrategy::full ? metrology::RemarkId::circle_in_space
                                                                          : metrology::RemarkId::circle_plane_first));
  }
}

TEST(FitCylinder, ByHandAndWithoutAStartGiven) {
  Points points;
  for (int i = 0; i < 24; ++i)
    points.push_back({3.0 + 2.0 * std::cos(0.7 * i), 4.0 + 2.0 * std::sin(0.7 * i), 0.1 * i});
  const metrology::FittedCylinder fit = metrology::fitCylinder({points, {}});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  EXPECT_LT((fit.cylinder.axis.direction - Eigen::Vector3d::UnitZ()).norm(), 1e-14);
  EXPECT_LT((fit.cylinder.axis.point.head<2>() - Eigen::Vector2d(3, 4)).norm(), 1e-14);
  EXPECT_NEAR(fit.cylinder.axis.point.z(), 1.15, 1e-14);  // the points' mean
  EXPECT_NEAR(fit.cylinder.radius, 2.0, 1e-14);
}

TEST(Fits, AnExactShapeHasNoCovarianceUnlessTheReadingsHave) {
  metrology::MeasuredPoints points{{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}};
  const metrology::FittedCircle bare = metrology::fitCircle(points);
  ASSERT_TRUE(bare.determined) << reports::words(bare.reason);
  EXPECT_FALSE(bare.covariance);
  points.covariances.assign(3, 1e-10 * Eigen::Matrix3d::Identity());
  ASSERT_TRUE(metrology::fitCircle(points).covariance);
  EXPECT_NEAR((*metrology::fitCircle(points).covariance)(2, 2), 0.5e-10,
              1e-20);  // between the first point and the third
}

/// What every fit says of points: reason, empty where it is determined.
struct Reasons {
  std::string line, plane, circle, plane_first, sphere, cylinder;
};

template <class Fit>
std::string reasonOf(const Fit& fit) {
  EXPECT_EQ(fit.determined, fit.reason.empty()) << reports::words(fit.reason);
  EXPECT_TRUE(fit.determined || !fit.covariance);
  EXPECT_TRUE(!fit.covariance || fit.covariance->allFinite());
  EXPECT_TRUE(std::isfinite(fit.rms + fit.residual_sd + fit.chi2_per_dof));
  return reports::words(fit.reason);
}

Reasons reasonsFor(const Points& points) {
  const metrology::MeasuredPoints readings{points, {}};
  return {reasonOf(metrology::fitLine(readings)),
          reasonOf(metrology::fitPlane(readings)),
          reasonOf(metrology::fitCircle(readings)),
          reasonOf(metrology::fitCircle(readings, metrology::CircleStrategy::plane_first)),
          reasonOf(metrology::fitSphere(readings)),
          reasonOf(metrology::fitCylinder(readings))};
}

void expectAll(const Points& points, const std::string& word) {
  const Reasons reasons = reasonsFor(points);
  for (const std::string& reason :
       {reasons.line, reasons.plane, reasons.circle, reasons.plane_first, reasons.sphere, reasons.cylinder}) {
    EXPECT_NE(reason.find(word), std::string::npos) << reason;
  }
}

TEST(Fits, RefuseWhatIsNoSetOfPoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Points cube{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  expectAll({}, "no readings");
  expectAll({{1, 2, 3}}, "1 is given");
  expectAll({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, "one place");
  for (const double wrong : {nan, inf, -inf}) {
    Points points = cube;
    points[3].y() = wrong;
    expectAll(points, "finite");
  }
  Points far = cube;
  for (Eigen::Vector3d& point : far) point += Eigen::Vector3d::Constant(1e13);
  expectAll(far, "far from the origin");
  far = cube;
  for (Eigen::Vector3d& point : far) point *= 1e299;
  expectAll(far, "too large");
}

TEST(Fits, TooFewReadingsSayHowManyAreNeeded) {
  const Points two{{0, 0, 0}, {1, 0, 0}};
  const Reasons of_two = reasonsFor(two);
  EXPECT_EQ(of_two.line, "");
  EXPECT_EQ(of_two.plane, "3 readings or more are needed, 2 are given");
  EXPECT_EQ(of_two.circle, of_two.plane);
  EXPECT_EQ(of_two.plane_first, of_two.plane);
  EXPECT_EQ(of_two.sphere, "4 readings or more are needed, 2 are given");
  EXPECT_EQ(of_two.cylinder, "5 readings or more are needed, 2 are given");
}

TEST(Fits, RefuseWhatDeterminesNoShape) {
  Points line, plane, ring;
  for (int i = 0; i < 8; ++i) {
    line.push_back(Eigen::Vector3d(100, 2, 3) + i * Eigen::Vector3d(0.1, 0.2, -0.05) / 3.0);
    ring.push_back(onCircle(kCentre, kAxis, 1.2, 0.0, radians(40.0 * i)));
  }
  const Reasons on_line = reasonsFor(line), on_ring = reasonsFor(ring);
  EXPECT_EQ(on_line.line, "");
  for (const std::string& reason : {on_line.plane, on_line.circle, on_line.plane_first, on_line.cylinder}) {
    EXPECT_NE(reason.find("one line"), std::string::npos) << reason;
  }
  EXPECT_NE(on_line.sphere.find("plane"), std::string::npos) << on_line.sphere;
  EXPECT_EQ(on_ring.circle + on_ring.plane, "");
  EXPECT_NE(on_ring.sphere.find("one plane"), std::string::npos) << on_ring.sphere;
  EXPECT_NE(on_ring.cylinder.find("one plane"), std::string::npos) << on_ring.cylinder;
  // A cube has no direction in which it spreads most or least.
  const Points cube{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_TRUE(metrology::fitLine({cube, {}}).reason.is(metrology::RemarkId::direction_spread_alike));
  EXPECT_TRUE(metrology::fitPlane({cube, {}}).reason.is(metrology::RemarkId::normal_spread_alike));
  EXPECT_TRUE(metrology::fitCylinder({cube, {}}).reason.is(metrology::RemarkId::two_cylinders_alike))
      << reports::words(metrology::fitCylinder({cube, {}}).reason);
}

TEST(Fits, RefuseWhatTheScatterContradicts) {
  Noise noise(12);
  Points line, plane;
  for (int i = 0; i < 30; ++i) {
    line.push_back(Eigen::Vector3d(0.1 * i, 0, 0) + 1e-4 * noise.normal3());
    plane.push_back(Eigen::Vector3d(noise.uniform(), noise.uniform(), 0) + 1e-4 * noise.normal3());
  }
  for (const metrology::CircleStrategy strategy :
       {metrology::CircleStrategy::full, metrology::CircleStrategy::plane_first}) {
    EXPECT_FALSE(metrology::fitCircle({line, {}}, strategy).determined);
  }
  EXPECT_FALSE(metrology::fitPlane({line, {}}).determined);
  const metrology::FittedSphere sphere = metrology::fitSphere({plane, {}});
  EXPECT_FALSE(sphere.determined) << sphere.sphere.radius << " " << sphere.rms << " " << (*sphere.covariance)(3, 3);
}

TEST(FitSphere, RefusesFewerThanFourAndWrongCovariances) {
  EXPECT_FALSE(metrology::fitSphere({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}}).determined);
  const Points points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}};
  metrology::MeasuredPoints readings{points, {Eigen::Matrix3d::Identity()}};
  EXPECT_TRUE(metrology::fitSphere(readings).reason.is(metrology::RemarkId::covariances_not_one_a_reading));
  readings.covariances.assign(5, Eigen::Matrix3d::Identity());
  EXPECT_TRUE(metrology::fitSphere(readings).determined);
  readings.covariances[2] = -Eigen::Matrix3d::Identity();
  EXPECT_TRUE(metrology::fitSphere(readings).reason.is(metrology::RemarkId::covariance_not_positive_definite));
}

TEST(FitCircle, NplExampleToAllPrintedDigits) {
  const auto file = reference("npl-circle3d.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  Points points;
  for (const auto& point : (*file)["points"]) points.push_back(vector(point));
  const metrology::FittedCircle fit = metrology::fitCircle({points, {}});
  ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
  const auto& published = (*file)["published"];
  const double half = 0.5001;  // of the last printed digit
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(fit.circle.centre[k], published["x0n"][at].get<double>(), 0.1 * half);
    EXPECT_NEAR(fit.circle.normal[k], published["an"][at].get<double>(), 1e-4 * half);
    for (std::size_t column = 0; column < 3; ++column) {
      const auto j = static_cast<Eigen::Index>(column);
      EXPECT_NEAR(1e3 * (*fit.covariance)(k, j), published["Vx0n_1e-3"][at][column].get<double>(), 1e-4 * half);
      EXPECT_NEAR(1e7 * (*fit.covariance)(3 + k, 3 + j), published["Van_1e-7"][at][column].get<double>(), 1e-4 * half);
    }
  }
  EXPECT_NEAR(fit.circle.radius, published["rn"].get<double>(), 1e-4 * half);
  EXPECT_NEAR(std::sqrt((*fit.covariance)(6, 6)), published["urn"].get<double>(), 1e-4 * half);
  EXPECT_NEAR(fit.residual_sd, published["sigmah"].get<double>(), 1e-4 * half);
}

TEST(FitCircle, PublishedGeometricCirclesInAnyPlane) {
  const auto file = reference("published-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  for (const char* name : {"circle2d_gander_golub_strebel_1994", "circle2d_skimage_5186"}) {
    const auto& one = (*file)[name];
    const auto& answer = one[one.contains("geometric_recomputed") ? "geometric_recomputed" : "geometric"];
    for (const double height : {0.0, 5.0}) {  // planes off the origin: some programs return a wrong centre there
      Points points;
      for (std::size_t i = 0; i < one["x"].size(); ++i) {
        points.push_back({one["x"][i].get<double>(), one["y"][i].get<double>(), height});
      }
      const metrology::FittedCircle fit = metrology::fitCircle({points, {}});
      ASSERT_TRUE(fit.determined) << name << ": " << reports::words(fit.reason);
      const Eigen::Vector3d centre = vector(answer["c"]) + height * Eigen::Vector3d::UnitZ();
      EXPECT_LT((fit.circle.centre - centre).norm(), 2e-8) << name;  // as printed: eight decimals and more
      EXPECT_NEAR(fit.circle.radius, answer["r"].get<double>(), 2e-8) << name;
    }
  }
}

/// What an OpenIndy entry expects of a fit, by the names of its list; directions up to their sense.
struct Found {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double radius = 0.0, stdev = 0.0;
};

void compare(const nlohmann::json& test, Found found) {
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (const auto& one : test["expected"]) {
    if (one["what"][0] == "direction") expected[one["what"][1].get<Eigen::Index>()] = one["value"].get<double>();
  }
  if (expected.dot(found.direction) < 0.0) found.direction *= -1.0;
  for (const auto& one : test["expected"]) {
    const std::string what = one["what"][0];
    const double value = one["value"].get<double>(), tolerance = one["tol"].get<double>();
    if (what == "direction") {
      EXPECT_NEAR(found.direction[one["what"][1].get<Eigen::Index>()], value, tolerance);
    }
    if (what == "radius") {
      EXPECT_NEAR(found.radius, value, tolerance);
    }
    if (what == "stdev") {
      EXPECT_NEAR(found.stdev, value, tolerance);
    }
  }
}

TEST(Fits, OpenIndyVectorsWithinTheirOwnTolerances) {
  const auto file = reference("openindy-fit-vectors.json");
  if (!file) GTEST_SKIP() << "reference data are not beside the checkout";
  int compared = 0;
  for (const auto& test : (*file)["tests"]) {
    const std::string name = test["test"];
    SCOPED_TRACE(name);
    metrology::MeasuredPoints points;
    for (const auto& point : test["points"]) points.points.push_back(vector(point));
    const auto named = [&name](const char* part) { return name.find(part) != std::string::npos; };
    if (test["skipped_upstream"].get<bool>() || named("BestFitPoint")) continue;
    ++compared;
    if (named("Plane") && !named("Circle")) {
      const metrology::FittedPlane fit = metrology::fitPlane(points);
      ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
      compare(test, {fit.plane.normal, 0.0, fit.residual_sd});
    } else if (named("Line")) {
      const metrology::FittedLine fit = metrology::fitLine(points);
      ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
      // OpenIndy counts a point's distance as one residual (n - 2), not as its two components (2 n - 4).
      compare(test, {fit.line.direction, 0.0, std::sqrt(2.0) * fit.residual_sd});
    } else if (named("Circle")) {
      const metrology::FittedCircle fit = metrology::fitCircle(points, metrology::CircleStrategy::plane_first);
      ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
      compare(test, {fit.circle.normal, fit.circle.radius, fit.residual_sd});
    } else if (named("Sphere")) {
      const metrology::FittedSphere fit = metrology::fitSphere(points);
      ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
      // Of a sphere it counts three coordinates a point (3 n - 4); its residuals, printed to 1e-5, say the
      // same.
      const double coordinates = 3.0 * static_cast<double>(points.points.size()) - 4.0;
      compare(test, {Eigen::Vector3d::Zero(), fit.sphere.radius,
                     fit.residual_sd * std::sqrt(fit.degrees_of_freedom / coordinates)});
      for (const auto& one : test["expected"]) {
        if (one["what"][0] != "residual" || one["what"][1] >= 3000) continue;  // 3000: points that were not fitted
        const Eigen::Vector3d& point = points.points[one["what"][1].get<std::size_t>() - 1000];
        EXPECT_NEAR((point - fit.sphere.centre).norm() - fit.sphere.radius, one["value"].get<double>(), 1e-5);
      }
    } else {
      const metrology::FittedCylinder fit = metrology::fitCylinder(points);
      ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
      compare(test, {fit.cylinder.axis.direction, fit.cylinder.radius, fit.residual_sd});
    }
  }
  EXPECT_GE(compared, 10);
}

}  // namespace fits_test
}  // namespace stiffscope
