#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"
#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace propagation_test {

metrology::MeasuredLine someLine() {
  metrology::MeasuredLine line;
  line.line = {{1.2, -0.4, 0.3}, Eigen::Vector3d(0.2, -0.5, 0.8).normalized()};
  metrology::basisAcross(line.line.direction, line.across_u, line.across_v);
  return line;
}

TEST(MeasuredLine, StepToUndoesMoved) {
  const metrology::MeasuredLine line = someLine();
  const Eigen::Vector4d step(2e-3, -1e-3, 3e-3, 4e-3);
  metrology::Line moved = line.moved(step);
  moved.point += 0.7 * moved.direction;  // the same line by another of its points
  // Exact but for rounding of a metre.
  EXPECT_LT((line.stepTo(moved) - step).norm(), 1e-14);
  moved.direction = -moved.direction;
  EXPECT_LT((line.stepTo(moved) - step).norm(), 1e-14);
}

TEST(MeasuredLine, ReversedIsTheSameLineWithTheSameRegion) {
  metrology::MeasuredLine line = someLine();
  Eigen::Matrix4d half = Eigen::Matrix4d::Identity();
  half(2, 0) = 0.9, half(3, 1) = -0.7;
  line.covariance = half * half.transpose();
  const metrology::MeasuredLine other = line.reversed();
  // Another line is as far from either, measured by the covariance of each.
  const metrology::Line moved = line.moved({1e-3, 2e-3, -3e-3, 1e-3});
  const Eigen::Vector4d from = line.stepTo(moved), from_other = other.stepTo(moved);
  const double distance = from.dot(line.covariance.inverse() * from);
  EXPECT_NEAR(from_other.dot(other.covariance.inverse() * from_other), distance, 1e-12 * distance);
}

TEST(LineDerivatives, OfAPointsHeightAboveALine) {
  // Height of x along a line through p: d . (x - p). Tilting d towards u by a moves it by a u . (x - p); a shift
  // across does nothing.
  const metrology::MeasuredLine line = someLine();
  const Eigen::Vector3d x(0.3, 0.9, 2.0);
  const Eigen::MatrixXd by = metrology::derivativesByLines({line}, [&](const std::vector<metrology::Line>& lines) {
    return Eigen::VectorXd::Constant(1, lines[0].direction.dot(x - lines[0].point));
  });
  const Eigen::Vector3d from = x - line.line.point;
  const Eigen::RowVector4d expected(0.0, 0.0, line.across_u.dot(from), line.across_v.dot(from));
  EXPECT_LT((by - expected).norm(), 1e-8);  // rounding of metres over steps of 2e-7
}

TEST(LineDerivatives, TheTiltOfPerpendicularLinesGoesOnBeyondTheRightAngle) {
  // About x: the second line, along y, tilts by its own tilt towards z one to one, in either sense of its direction.
  metrology::MeasuredLine first, second;
  first.line = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  first.across_u = Eigen::Vector3d::UnitX(), first.across_v = Eigen::Vector3d::UnitY();
  for (const double sense : {1.0, -1.0}) {
    for (const double off : {0.0, 1e-12, -1e-12}) {
      second.line = {Eigen::Vector3d::UnitX(), sense * Eigen::Vector3d(0.0, 1.0, off).normalized()};
      second.across_u = Eigen::Vector3d::UnitX(), second.across_v = Eigen::Vector3d::UnitZ();
      const metrology::LinePairNumber tilt = metrology::tiltAbout(Eigen::Vector3d::UnitX(), first.line, second.line);
      EXPECT_NEAR(std::abs(tilt(first.line, second.line)), 0.5 * std::numbers::pi, 1e-11);
      const Eigen::MatrixXd by =
          metrology::derivativesByLines({first, second}, [&](const std::vector<metrology::Line>& lines) {
            return Eigen::VectorXd::Constant(1, tilt(lines[0], lines[1]));
          });
      EXPECT_NEAR(std::abs(by(0, 7)), 1.0, 1e-7) << sense << ", " << off;
      EXPECT_NEAR(std::abs(by(0, 3)), 1.0, 1e-7);
      EXPECT_NEAR(by(0, 6), 0.0, 1e-7);
    }
  }
}

TEST(FrameError, AFrameTurnedByHand) {
  // Measured frame turned by 1 mrad about its z and set 2 mm along its x: a point on the true x axis at 1 m is read
  // at -1 mm in y and 2 mm less in x.
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  truth.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  truth.translation() << 3, 2, 1;
  Eigen::Isometry3d off = Eigen::Isometry3d::Identity();
  off.linear() = Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  off.translation() << 2e-3, 0, 0;
  const metrology::FrameError error = metrology::frameError(truth, truth * off);
  EXPECT_LT((error - (metrology::FrameError() << 0, 0, 1e-3, 2e-3, 0, 0).finished()).norm(),
            1e-9);  // third order of 1e-3
  const Eigen::Vector3d x(1, 0, 0);
  const Eigen::Vector3d change = metrology::pointByFrameError(x) * error;
  EXPECT_LT((change - Eigen::Vector3d(-2e-3, -1e-3, 0)).norm(), 1e-9);
  EXPECT_LT(((truth * off).inverse() * (truth * x) - x - change).norm(), 3e-6);  // second order of 1e-3
  EXPECT_LT((metrology::vectorByFrameError(x) * error - Eigen::Vector3d(0, -1e-3, 0)).norm(), 1e-9);
}

}  // namespace propagation_test
}  // namespace stiffscope
