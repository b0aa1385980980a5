#include "metrology/line_pair_uncertainty.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "metrology/common_perpendicular.h"
#include "metrology/line_derivatives.h"

namespace stiffscope {

LinePairNumber signedDistance(const Line& first, const Line& second) {
  const Eigen::Vector3d normal = first.direction.cross(second.direction).normalized();
  const double sign = normal.dot(second.point - first.point) < 0.0 ? -1.0 : 1.0;
  return [normal, sign](const Line& a, const Line& b) {
    const Eigen::Vector3d across = a.direction.cross(b.direction).normalized();
    return (across.dot(normal) < 0.0 ? -sign : sign) * across.dot(b.point - a.point);
  };
}

LinePairNumber tiltAbout(const Eigen::Vector3d& normal) {
  return [normal](const Line& a, const Line& b) {
    const double cosine = a.direction.dot(b.direction);
    return std::atan2(normal.dot(a.direction.cross(b.direction)) * (cosine < 0.0 ? -1.0 : 1.0), std::abs(cosine));
  };
}

std::optional<Eigen::Vector3d> commonNormal(const Line& first, const Line& second) {
  const Eigen::Vector3d cross = first.direction.cross(second.direction);
  constexpr double kParallel = 1e-12;
  if (!(cross.norm() > kParallel)) return std::nullopt;
  const double sense = first.direction.dot(second.direction) < 0.0 ? -1.0 : 1.0;
  return sense * cross.normalized();
}

double propagatePair(const MeasuredLine& first, const MeasuredLine& second, const LinePairNumber& number) {
  const Eigen::MatrixXd by = derivativesByLines({first, second}, [&](const std::vector<Line>& lines) {
    return Eigen::VectorXd::Constant(1, number(lines[0], lines[1]));
  });
  const Eigen::RowVector4d by_first = by.leftCols<4>(), by_second = by.rightCols<4>();
  return std::sqrt(by_first.dot(by_first * first.covariance) + by_second.dot(by_second * second.covariance));
}

double distanceUncertainty(const MeasuredLine& first, const MeasuredLine& second) {
  return propagatePair(first, second, signedDistance(first.line, second.line));
}

double distanceAcrossUncertainty(const MeasuredLine& first, const MeasuredLine& second,
                                 const Eigen::Vector3d& at_point) {
  return propagatePair(first, second,
                       [&](const Line& a, const Line& b) { return distanceAcross(a, b, at_point); });
}

double angleUncertainty(const MeasuredLine& first, const MeasuredLine& second) {
  if (const auto normal = commonNormal(first.line, second.line)) {
    return propagatePair(first, second, tiltAbout(*normal));
  }
  // Exactly parallel: the larger of the tilts in two planes.
  return std::max(propagatePair(first, second, tiltAbout(first.across_u)),
                  propagatePair(first, second, tiltAbout(first.across_v)));
}

}  // namespace stiffscope
