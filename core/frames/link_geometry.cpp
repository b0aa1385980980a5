#include "core/frames/link_geometry.h"

#include <numbers>

#include "metrology/common_perpendicular.h"

namespace stiffscope {

namespace {

constexpr double kNearParallel = std::numbers::pi / 180.0;

}  // namespace

Eigen::Vector3d hayatiPoint(const std::array<Line, 6>& axes, std::size_t first) {
  if (first == 0) return axes[0].point;
  if (angleBetween(axes[first - 1], axes[first]) < kNearParallel)
    return nearestPoint(axes[first], hayatiPoint(axes, first - 1));
  return commonPerpendicular(axes[first - 1], axes[first]).foot_on_second;
}

std::array<LinkGeometry, 5> linkGeometry(const Robot& nominal, const ArmInR0& arm) {
  std::array<LinkGeometry, 5> links;
  const auto& actual = arm.arm.axes_in_base_at_zero;
  const auto& urdf = nominal.axes_in_base_at_zero;
  for (std::size_t i = 0; i < links.size(); ++i) {
    LinkGeometry& link = links[i];
    link.angle = angleBetween(actual[i], actual[i + 1]);
    link.nominal_angle = angleBetween(urdf[i], urdf[i + 1]);
    link.near_parallel = link.nominal_angle < kNearParallel;
    if (link.near_parallel) {
      link.at_point_in_r0 = hayatiPoint(actual, i);
      link.distance = distanceAcross(actual[i], actual[i + 1], link.at_point_in_r0);
      link.nominal_distance = distanceAcross(urdf[i], urdf[i + 1], hayatiPoint(urdf, i));
    } else {
      link.distance = commonPerpendicular(actual[i], actual[i + 1]).distance;
      link.nominal_distance = commonPerpendicular(urdf[i], urdf[i + 1]).distance;
    }
  }
  return links;
}

}  // namespace stiffscope
