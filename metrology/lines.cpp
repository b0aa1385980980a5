#include "metrology/lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace stiffscope::metrology {

AxisFrame::AxisFrame(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
  axis_.line = {point, direction.normalized()};
  setBasis();
}

void AxisFrame::setBasis() {
  basisAcross(axis_.line.direction, axis_.across_u, axis_.across_v);
  long double square = 0.0L;
  for (int k = 0; k < 3; ++k) square += static_cast<long double>(axis_.line.direction[k]) * axis_.line.direction[k];
  const long double inverse = 1.0L / std::sqrt(square);
  for (int k = 0; k < 3; ++k) exact_[k] = inverse * axis_.line.direction[k];
}

void AxisFrame::move(const Eigen::Vector4d& step) {
  axis_.line = axis_.moved(step);
  setBasis();
}

Eigen::Vector3d largestPositive(const Eigen::Vector3d& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0.0 ? Eigen::Vector3d(-direction) : direction;
}

CommonPerpendicular commonPerpendicular(const Line& first, const Line& second) {
  // The difference of the feet is at right angles to both directions: a 2x2 system for the two places.
  const Eigen::Vector3d between = second.point - first.point;
  const double cosine = first.direction.dot(second.direction);
  const double sine_squared = first.direction.cross(second.direction).squaredNorm();
  const double along_first = between.dot(first.direction);
  const double along_second = between.dot(second.direction);
  CommonPerpendicular result;
  const double s = sine_squared > 0.0 ? (along_first - cosine * along_second) / sine_squared : 0.0;
  const double t = cosine * s - along_second;
  result.foot_on_first = first.point + s * first.direction;
  result.foot_on_second = second.point + t * second.direction;
  result.distance = (result.foot_on_second - result.foot_on_first).norm();
  result.angle = angleBetween(first, second);
  return result;
}

double distanceAcross(const Line& first, const Line& second, const Eigen::Vector3d& at_point) {
  const Eigen::Vector3d on_first = nearestPoint(first, at_point);
  const double t = first.direction.dot(on_first - second.point) / first.direction.dot(second.direction);
  return (second.point + t * second.direction - on_first).norm();
}

double angleBetween(const Line& first, const Line& second) {
  return std::atan2(first.direction.cross(second.direction).norm(), std::abs(first.direction.dot(second.direction)));
}

Eigen::Vector3d nearestPoint(const Line& line, const Eigen::Vector3d& point) {
  return line.point + line.direction.dot(point - line.point) * line.direction;
}

Eigen::MatrixXd derivativesByLines(const std::vector<MeasuredLine>& lines, const LineNumbers& numbers) {
  constexpr double kStep = 1e-7;  // m and rad: of metres, central differences keep eight digits
  std::vector<Line> moved;
  for (const MeasuredLine& line : lines) moved.push_back(line.line);
  Eigen::MatrixXd derivatives;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(k);
      moved[i] = lines[i].moved(step);
      const Eigen::VectorXd ahead = numbers(moved);
      moved[i] = lines[i].moved(-step);
      const Eigen::VectorXd behind = numbers(moved);
      if (derivatives.size() == 0) derivatives.resize(ahead.size(), 4 * static_cast<Eigen::Index>(lines.size()));
      derivatives.col(4 * static_cast<Eigen::Index>(i) + k) = (ahead - behind) / (2.0 * kStep);
    }
    moved[i] = lines[i].line;
  }
  return derivatives;
}

LinePairNumber signedDistance(const Line& first, const Line& second) {
  const Eigen::Vector3d normal = first.direction.cross(second.direction).normalized();
  const double sign = normal.dot(second.point - first.point) < 0.0 ? -1.0 : 1.0;
  return [normal, sign](const Line& a, const Line& b) {
    const Eigen::Vector3d across = a.direction.cross(b.direction).normalized();
    return (across.dot(normal) < 0.0 ? -sign : sign) * across.dot(b.point - a.point);
  };
}

LinePairNumber tiltAbout(const Eigen::Vector3d& normal, const Line& first, const Line& second) {
  // The sense is that of the lines as they stand: by that of each moved pair the angle would leap at a right angle.
  const double sense = first.direction.dot(second.direction) < 0.0 ? -1.0 : 1.0;
  return [normal, sense](const Line& a, const Line& b) {
    return std::atan2(sense * normal.dot(a.direction.cross(b.direction)), sense * a.direction.dot(b.direction));
  };
}

std::optional<Eigen::Vector3d> commonNormal(const Line& first, const Line& second) {
  const Eigen::Vector3d cross = first.direction.cross(second.direction);
  constexpr double kParallel = 1e-12;
  if (!(cross.norm() > kParallel)) return std::nullopt;
  const double sense = first.direction.dot(second.direction) < 0.0 ? -1.0 : 1.0;
  return sense * cross.normalized();
}

Line MeasuredLine::moved(const Eigen::Vector4d& step) const {
  return {line.point + step[0] * across_u + step[1] * across_v,
          (line.direction + step[2] * across_u + step[3] * across_v).normalized()};
}

MeasuredLine MeasuredLine::reversed() const {
  MeasuredLine other = *this;
  other.line.direction = -line.direction;
  other.covariance.topRightCorner<2, 2>() *= -1.0;
  other.covariance.bottomLeftCorner<2, 2>() *= -1.0;
  return other;
}

Eigen::Vector4d MeasuredLine::stepTo(const Line& other) const {
  const double along = line.direction.dot(other.direction);
  const double to_plane = line.direction.dot(line.point - other.point) / along;
  const Eigen::Vector3d shift = other.point + to_plane * other.direction - line.point;
  return {across_u.dot(shift), across_v.dot(shift), across_u.dot(other.direction) / along,
          across_v.dot(other.direction) / along};
}

void basisAcross(const Eigen::Vector3d& direction, Eigen::Vector3d& u, Eigen::Vector3d& v) {
  u = direction.unitOrthogonal();
  v = direction.cross(u);
}

}  // namespace stiffscope::metrology
