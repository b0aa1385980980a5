#include "metrology/swept_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrology/measured_line.h"

namespace stiffscope {

double sweptArc(const Line& axis, const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 2) return 0.0;
  Eigen::Vector3d u, v;
  basisAcross(axis.direction, u, v);
  std::vector<double> angles;
  angles.reserve(points.size());
  for (const auto& point : points) {
    angles.push_back(std::atan2(v.dot(point - axis.point), u.dot(point - axis.point)));
  }
  std::sort(angles.begin(), angles.end());
  double gap = 2.0 * std::numbers::pi - (angles.back() - angles.front());
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return 2.0 * std::numbers::pi - gap;
}

}  // namespace stiffscope
