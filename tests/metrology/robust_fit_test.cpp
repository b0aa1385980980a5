#include "metrology/robust_fit.h"
#include "metrology/remarks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include "metrology/tail_probability.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace robust_fit_test {

const Eigen::Vector3d kCentre(2.1, -1.3, 0.8);
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();
constexpr double kNoise = 2e-5;  // m

enum class Shape { line, plane, circle, sphere, cylinder };

Eigen::Vector3d on(Shape shape, Noise& noise) {
  const double angle = 2.0 * noise.uniform(), along = noise.uniform() - 0.5;  // 115 degrees of arc
  switch (shape) {
    case Shape::line:
      return kCentre + 2.0 * along * kAxis;
    case Shape::plane:
      return onCircle(kCentre, kAxis, std::sqrt(noise.uniform()), 0.0, 3.0 * angle);
    case Shape::circle:
      return onCircle(kCentre, kAxis, 1.2, 0.0, angle);
    case Shape::cylinder:
      return onCircle(kCentre, kAxis, 1.2, along, angle);
    case Shape::sphere:
      break;
  }
  Eigen::Vector3d outward = noise.direction();
  while (outward.dot(kAxis) < 0.3) outward = noise.direction();
  return kCentre + 0.6 * outward;
}

metrology::MeasuredPoints readings(Shape shape, std::size_t count, Noise& noise, bool with_covariances) {
  metrology::MeasuredPoints points;
  for (std::size_t i = 0; i < count; ++i) points.points.push_back(on(shape, noise) + kNoise * noise.normal3());
  if (with_covariances) points.covariances.assign(count, kNoise * kNoise * Eigen::Matrix3d::Identity());
  return points;
}

/// The readings that a robust fit leaves out, in rising order; -1 where the fit is not determined.
std::vector<int> leftOut(Shape shape, const metrology::MeasuredPoints& points, int* degrees_of_freedom = nullptr) {
  const auto run = [&](const auto& fitTo) {
    const auto robust = metrology::fitRobustly(points, fitTo);
    if (degrees_of_freedom != nullptr) *degrees_of_freedom = robust.fit.degrees_of_freedom;
    std::vector<int> found;
    for (const metrology::RejectedReading& one : robust.rejected) found.push_back(static_cast<int>(one.index));
    if (!robust.fit.determined) found.push_back(-1);
    std::sort(found.begin(), found.end());
    return found;
  };
  switch (shape) {
    case Shape::line:
      return run(metrology::fitLine);
    case Shape::plane:
      return run(metrology::fitPlane);
    case Shape::circle:
      return run([](const metrology::MeasuredPoints& some) { return metrology::fitCircle(some); });
    case Shape::sphere:
      return run(metrology::fitSphere);
    case Shape::cylinder:
      break;
  }
  return run(metrology::fitCylinder);
}

constexpr std::array kShapes{Shape::line, Shape::plane, Shape::circle, Shape::sphere, Shape::cylinder};

TEST(TailProbability, TablesOfStudentChiSquareAndF) {
  // Quantiles as printed in tables, four digits behind the point.
  EXPECT_NEAR(metrology::chiSquareTail(3.8415, 1), 0.05, 1e-5);
  EXPECT_NEAR(metrology::chiSquareTail(5.9915, 2), 0.05, 1e-5);
  EXPECT_NEAR(metrology::fTail(2.2281 * 2.2281, 1, 10), 0.05, 1e-5);  // Student, 10 degrees, two-sided
  EXPECT_NEAR(metrology::fTail(12.7062 * 12.7062, 1, 1), 0.05, 1e-5);
  EXPECT_NEAR(metrology::fTail(4.1028, 2, 10), 0.05, 1e-5);
  EXPECT_NEAR(metrology::fTail(3.8415, 1, 1e6), 0.05, 2e-5);
  // Abramowitz and Stegun, tables 26.8 and 26.9; limits undo tails.
  EXPECT_NEAR(metrology::chiSquareLimit(0.05, 1), 3.84146, 5e-6);
  EXPECT_NEAR(metrology::chiSquareLimit(0.01, 2), 9.21034, 5e-6);
  EXPECT_NEAR(metrology::fLimit(0.05, 1, 30), 4.17, 5e-3);
  EXPECT_NEAR(metrology::fLimit(0.05, 2, 120), 3.07, 5e-3);
  for (const double below : {10.0, 30.0, 100.0, 1e3, 3e4, 1e5, 1e6}) {
    for (const int above : {1, 2})
      EXPECT_NEAR(metrology::fTail(metrology::fLimit(1e-4, above, below), above, below), 1e-4, 1e-14) << below;
    // F of two degrees has its tail in closed form: (1 + 2 f / n)^(-n / 2).
    EXPECT_NEAR(metrology::fTail(9.0, 2, below) / std::pow(1.0 + 18.0 / below, -0.5 * below), 1.0, 1e-9) << below;
  }
  EXPECT_EQ(metrology::fTail(std::numeric_limits<double>::infinity(), 1, 10), 0.0);
}

TEST(FitRobustly, GoodReadingsAreRarelyRejected) {
  // The stated level: a set of good readings loses one in 1 % of the cases. 2000 sets: 20 +- 4.5. The tests
  // of one set are not independent, which makes Sidak's level a little strict; the bound below is zero to
  // that.
  for (const Shape shape : {Shape::line, Shape::plane, Shape::circle, Shape::sphere}) {
    for (const bool with_covariances : {false, true}) {
      Noise noise(40 + static_cast<std::uint64_t>(shape));
      int sets = 0;
      for (int k = 0; k < 2000; ++k) sets += !leftOut(shape, readings(shape, 20, noise, with_covariances)).empty();
      EXPECT_GT(sets, 4) << static_cast<int>(shape) << with_covariances;
      EXPECT_LT(sets, 36) << static_cast<int>(shape) << with_covariances;
    }
  }
}

TEST(FitRobustly, GoodReadingsOfACylinderAreRarelyRejected) {
  // As above; 600 sets, since a cylinder is fitted from several starts: 6 +- 2.4, a Poisson count of which 0 and more
  // than 14 are less likely than 0.3 %.
  for (const bool with_covariances : {false, true}) {
    Noise noise(51);
    int sets = 0;
    for (int k = 0; k < 600; ++k)
      sets += !leftOut(Shape::cylinder, readings(Shape::cylinder, 24, noise, with_covariances)).empty();
    EXPECT_GT(sets, 0) << with_covariances;
    EXPECT_LE(sets, 14) << with_covariances;
  }
}

TEST(FitRobustly, GoodCirclesOfAnAxisAreRarelyRejected) {
  // Three reflectors about one axis, 39 readings of two residuals each, a tracker's noise. 2000 sets at 1 %: 20 +- 4.5.
  for (const bool with_covariances : {false, true}) {
    Noise noise(52);
    int sets = 0;
    for (int k = 0; k < 2000; ++k) {
      std::vector<metrology::CirclePoints> circles(3);
      for (std::size_t target = 0; target < 3; ++target) {
        for (int i = 0; i < 13; ++i) {
          const Eigen::Vector3d point = onCircle(kCentre, kAxis, 1.8 + 0.1 * static_cast<double>(target),
                                                 0.2 * static_cast<double>(target), radians(7.0 * i));
          const Eigen::Matrix3d covariance = with_covariances
                                                 ? seenFromOrigin(point, 0.3 * kNoise, kNoise)
                                                 : Eigen::Matrix3d(kNoise * kNoise * Eigen::Matrix3d::Identity());
          circles[target].points.push_back(point + noise.draw(covariance));
          if (with_covariances) circles[target].covariances.push_back(covariance);
        }
      }
      const auto robust = metrology::fitRobustly(circles, metrology::fitAxis);
      EXPECT_TRUE(robust.fit.determined);
      sets += !robust.rejected.empty();
    }
    EXPECT_GT(sets, 4) << with_covariances;
    EXPECT_LT(sets, 36) << with_covariances;
  }
}

TEST(FitRobustly, PlantedErrorsAreFoundAndOnlyThose) {
  // Two of thirty readings off by 30 standard deviations along the normal or radius. Only those: but for the
  // good reading that one set in a hundred loses, hence 195 of 200.
  for (const Shape shape : kShapes) {
    for (const bool with_covariances : {false, true}) {
      Noise noise(70 + static_cast<std::uint64_t>(shape));
      const int sets = shape == Shape::cylinder ? 50 : 200;
      int exact = 0;
      for (int k = 0; k < sets; ++k) {
        metrology::MeasuredPoints points = readings(shape, 30, noise, with_covariances);
        for (const std::size_t wrong : {4u, 17u}) {
          const Eigen::Vector3d from = points.points[wrong] - kCentre;
          const Eigen::Vector3d radial = (from - kAxis.dot(from) * kAxis).normalized();
          const Eigen::Vector3d off = shape == Shape::plane    ? kAxis
                                      : shape == Shape::line   ? kAxis.unitOrthogonal()
                                      : shape == Shape::sphere ? Eigen::Vector3d(from.normalized())
                                                               : radial;
          points.points[wrong] += 30.0 * kNoise * off;
        }
        int left = 0;
        exact += leftOut(shape, points, &left) == std::vector<int>{4, 17};
      }
      EXPECT_GE(exact, sets * 195 / 200 - 1) << static_cast<int>(shape) << with_covariances;
    }
  }
}

TEST(FitRobustly, DegreesOfFreedomAreThoseOfTheReadingsLeft) {
  Noise noise(5);
  metrology::MeasuredPoints points = readings(Shape::circle, 20, noise, false);
  points.points[7] += Eigen::Vector3d(0, 0, 0.01);
  const auto robust =
      metrology::fitRobustly(points, [](const metrology::MeasuredPoints& some) { return metrology::fitCircle(some); });
  ASSERT_EQ(robust.rejected.size(), 1u);
  EXPECT_EQ(robust.rejected[0].index, 7u);
  EXPECT_GT(robust.rejected[0].w, robust.rejected[0].critical_w);
  EXPECT_EQ(robust.fit.degrees_of_freedom, 2 * 19 - 6);
  EXPECT_LT(robust.fit.residual_sd, 1.6 * kNoise);  // as good as without: 32 degrees, +4 sigma
}

TEST(FitRobustly, ALostBeamAmongTheCirclesOfAnAxis) {
  // A reading of (0, 0, 0), as trackers give when the beam is lost, in the second of three reflectors'
  // circles.
  Noise noise(6);
  std::vector<metrology::CirclePoints> circles(3);
  for (std::size_t k = 0; k < 3; ++k) {
    for (int i = 0; i < 13; ++i) {
      circles[k].points.push_back(
          onCircle(kCentre, kAxis, 1.8 + 0.1 * static_cast<double>(k), 0.2 * static_cast<double>(k), radians(9.0 * i)) +
          kNoise * noise.normal3());
    }
  }
  circles[1].points[6].setZero();
  const auto robust = metrology::fitRobustly(circles, metrology::fitAxis);
  ASSERT_TRUE(robust.fit.determined) << reports::words(robust.fit.reason);
  ASSERT_EQ(robust.rejected.size(), 1u);
  EXPECT_EQ(robust.rejected[0].group, 1u);
  EXPECT_EQ(robust.rejected[0].index, 6u);
  EXPECT_EQ(robust.fit.degrees_of_freedom, 2 * 38 - 10);
}

TEST(FitRobustly, ExactReadingsLoseNone) {
  metrology::MeasuredPoints points;
  for (int i = 0; i < 12; ++i) points.points.push_back(onCircle(kCentre, kAxis, 1.2, 0.0, radians(20.0 * i)));
  EXPECT_TRUE(leftOut(Shape::circle, points).empty());
}

TEST(FitRobustly, SaysWhereItCannotTellWhichAreWrong) {
  // Half of the readings on one plane, half on another.
  Noise noise(9);
  metrology::MeasuredPoints points = readings(Shape::plane, 12, noise, true);
  for (std::size_t i = 0; i < 12; i += 2) points.points[i] += 0.01 * kAxis;
  const auto robust = metrology::fitRobustly(points, metrology::fitPlane);
  EXPECT_FALSE(robust.fit.determined);
  EXPECT_TRUE(robust.fit.reason.is(metrology::RemarkId::readings_contradict)) << reports::words(robust.fit.reason);
}

}  // namespace robust_fit_test
}  // namespace stiffscope
