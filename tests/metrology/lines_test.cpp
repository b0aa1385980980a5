#include "metrology/lines.h"
#include <gtest/gtest.h>
#include "metrology/axis_fit.h"
#include "metrology/measured_points.h"
#include "metrology/rigid_motion.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace lines_test {

TEST(CommonPerpendicular, ByHand) {
  // The x axis, and a line along y three above it at x = 2.
  const metrology::CommonPerpendicular found =
      metrology::commonPerpendicular({{-7, 0, 0}, {1, 0, 0}}, {{2, 11, 3}, {0, 1, 0}});
  EXPECT_LT((found.foot_on_first - Eigen::Vector3d(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((found.foot_on_second - Eigen::Vector3d(2, 0, 3)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(found.distance, 3.0);
  EXPECT_DOUBLE_EQ(found.angle, std::numbers::pi / 2.0);
}

TEST(CommonPerpendicular, IsTheShortestWay) {
  Noise noise(4);
  for (int k = 0; k < 50; ++k) {
    const metrology::Line first{noise.normal3(), noise.direction()}, second{noise.normal3(), noise.direction()};
    const metrology::CommonPerpendicular found = metrology::commonPerpendicular(first, second);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d a = first.point + 3.0 * noise.normal() * first.direction;
      const Eigen::Vector3d b = second.point + 3.0 * noise.normal() * second.direction;
      EXPECT_LE(found.distance, (a - b).norm() + 1e-12);
    }
    EXPECT_NEAR((found.foot_on_first - found.foot_on_second).dot(first.direction), 0.0, 1e-9);
    EXPECT_NEAR((found.foot_on_first - found.foot_on_second).dot(second.direction), 0.0, 1e-9);
  }
}

TEST(CommonPerpendicular, ParallelLinesAreFiniteAndKeepTheirDistance) {
  const metrology::CommonPerpendicular found =
      metrology::commonPerpendicular({{0, 0, 5}, {0, 0, 1}}, {{3, 4, -2}, {0, 0, 1}});
  EXPECT_DOUBLE_EQ(found.distance, 5.0);
  EXPECT_DOUBLE_EQ(found.angle, 0.0);
  EXPECT_TRUE(found.foot_on_first.allFinite());
  EXPECT_DOUBLE_EQ(metrology::commonPerpendicular({{0, 0, 5}, {0, 0, 1}}, {{3, 4, -2}, {0, 0, -1}}).distance, 5.0);
}

TEST(DistanceAcross, ByHand) {
  // A line that leans by 0.1 in x per z: at z = 2 it stands at x = 1.2.
  const metrology::Line upright{{0, 0, -9}, {0, 0, 1}};
  const metrology::Line leaning{{1, 0, 0}, Eigen::Vector3d(0.1, 0, 1).normalized()};
  EXPECT_NEAR(metrology::distanceAcross(upright, leaning, {0, 0, 2}), 1.2, 1e-15);
  EXPECT_NEAR(metrology::distanceAcross(upright, leaning, {7, -5, 2}), 1.2,
              1e-15);  // only the place along the axis counts
  EXPECT_NEAR(metrology::distanceAcross(upright, {{3, 4, 1}, {0, 0, -1}}, {0, 0, 2}), 5.0, 1e-15);  // parallel
}

TEST(AngleBetween, SmallAnglesKeepTheirDigits) {
  EXPECT_NEAR(metrology::angleBetween({{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {std::sin(1e-7), 0, -std::cos(1e-7)}}), 1e-7,
              1e-16);
}

TEST(SweptArc, ByHand) {
  const metrology::Line axis{{0, 0, 0}, {0, 0, 1}};
  const auto at = [](double degrees) {
    return Eigen::Vector3d(std::cos(radians(degrees)), std::sin(radians(degrees)), 0.3);
  };
  EXPECT_DOUBLE_EQ(metrology::sweptArc(axis, {}), 0.0);
  EXPECT_DOUBLE_EQ(metrology::sweptArc(axis, {at(10)}), 0.0);
  EXPECT_NEAR(metrology::sweptArc(axis, {at(10), at(50), at(30)}), radians(40), 1e-14);
  EXPECT_NEAR(metrology::sweptArc(axis, {at(170), at(-170), at(180)}), radians(20), 1e-14);  // through the cut of atan2
  EXPECT_NEAR(metrology::sweptArc(axis, {at(0), at(90), at(180), at(270)}), radians(270),
              1e-14);  // a full turn of four
  EXPECT_NEAR(metrology::sweptArc(axis, {at(25), at(25), at(25)}), 0.0, 1e-14);
}

TEST(BaseFrame, ByHand) {
  // Axis 1 upright at (1, 2); axis 2 along y, 0.3 ahead in x, 0.7 up, leaning up a little: z0, y0, origin are
  // seen.
  const metrology::Line axis_1{{1, 2, -5}, {0, 0, 1}};
  const metrology::Line axis_2{{1.3, 9, 0.7 + 7 * 0.01}, Eigen::Vector3d(0, 1, 0.01).normalized()};
  const Eigen::Isometry3d frame = metrology::baseFrame(axis_1, axis_2);
  EXPECT_LT((frame.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_LT((frame.translation() - Eigen::Vector3d(1, 2, 0.7)).norm(), 1e-14);
  const Eigen::Isometry3d other = metrology::baseFrame({{1, 2, -5}, {0, 0, -1}}, axis_2);
  EXPECT_LT((other.linear() - Eigen::Vector3d(-1, 1, -1).asDiagonal().toDenseMatrix()).norm(), 1e-15);
}

TEST(TrackerNoise, ByHand) {
  // 5 m along x from the station: 4 + 0.6 * 5 = 7 um along x, 6 + 2.2 * 5 = 17 um across.
  const metrology::TrackerNoise noise{4e-6, 0.6e-6, 6e-6, 2.2e-6, {1, 0, 0}};
  const Eigen::Matrix3d covariance = noise.covarianceAt({6, 0, 0});
  EXPECT_LT((1e12 * covariance - Eigen::Vector3d(49, 289, 289).asDiagonal().toDenseMatrix()).norm(), 1e-10);
  // 3-4-0 from the station: the same distance, turned.
  const Eigen::Matrix3d oblique = noise.covarianceAt({4, 4, 0});
  const Eigen::Vector3d beam(0.6, 0.8, 0.0), across(-0.8, 0.6, 0.0);
  EXPECT_NEAR(1e12 * beam.dot(oblique * beam), 49.0, 1e-10);
  EXPECT_NEAR(1e12 * across.dot(oblique * across), 289.0, 1e-10);
  EXPECT_NEAR(1e12 * beam.dot(oblique * across), 0.0, 1e-10);
  EXPECT_TRUE(noise.covarianceAt({1, 0, 0}).allFinite());
}

TEST(MeasuredLine, MovedByItsParameters) {
  metrology::MeasuredLine line;  // up the z axis
  const metrology::Line moved = line.moved({0.1, 0.2, 1e-3, -2e-3});
  EXPECT_LT((moved.point - Eigen::Vector3d(0.1, 0.2, 0)).norm(), 1e-15);
  EXPECT_LT((moved.direction - Eigen::Vector3d(1e-3, -2e-3, 1).normalized()).norm(), 1e-15);
  Eigen::Vector3d u, v;
  const Eigen::Vector3d direction = Eigen::Vector3d(0.2, -0.5, 0.8).normalized();
  metrology::basisAcross(direction, u, v);
  EXPECT_LT((u.cross(v) - direction).norm(), 1e-15);
}

}  // namespace lines_test
}  // namespace stiffscope
