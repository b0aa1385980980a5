#include "metrology/trilateration.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace stiffscope::metrology {

std::optional<TrilaterationFrame> trilaterationFrame(const Eigen::Vector3d& p10, const Eigen::Vector3d& p11,
                                                     const Eigen::Vector3d& p12) {
  TrilaterationFrame frame;
  frame.d = (p11 - p10).norm();
  if (frame.d == 0.0) return std::nullopt;
  frame.ex = (p11 - p10) / frame.d;
  frame.i = frame.ex.dot(p12 - p10);
  const Eigen::Vector3d across = p12 - p10 - frame.i * frame.ex;
  constexpr double kOnOneLine = 1e-9;  // of the longer side
  if (across.norm() <= kOnOneLine * std::max(frame.d, (p12 - p10).norm())) return std::nullopt;
  frame.ey = across.normalized();
  frame.j = frame.ey.dot(p12 - p10);
  frame.ez = frame.ex.cross(frame.ey);
  return frame;
}

std::optional<Trilateration> trilaterate(const std::array<Eigen::Vector3d, 3>& points,
                                         const std::array<double, 3>& radii) {
  const auto frame = trilaterationFrame(points[0], points[1], points[2]);
  if (!frame) return std::nullopt;
  const auto& [ex, ey, ez, d, i, j] = *frame;
  const double r0 = radii[0] * radii[0], r1 = radii[1] * radii[1], r2 = radii[2] * radii[2];
  const double x = (r0 - r1 + d * d) / (2.0 * d);                        // (15)
  const double y = (r0 - r2 + i * i + j * j) / (2.0 * j) - (i / j) * x;  // (16)
  Trilateration result;
  result.height_squared = r0 - x * x - y * y;
  const double z = std::sqrt(std::max(0.0, result.height_squared));  // (17)
  const Eigen::Vector3d foot = points[0] + x * ex + y * ey;
  result.roots = {foot + z * ez, foot - z * ez};  // (13), (14)
  return result;
}

Eigen::Vector3d nearerRoot(const Trilateration& both, const Eigen::Vector3d& expected) {
  const bool first = (both.roots[0] - expected).squaredNorm() <= (both.roots[1] - expected).squaredNorm();
  return both.roots[first ? 0 : 1];
}

}  // namespace stiffscope::metrology
