#include "core/frames/frames.h"

#include "metrology/lines.h"

namespace stiffscope::frames {

Eigen::Vector3d hayatiPoint(const robot::ArmAxes& axes, std::size_t first) {
  if (first == 0) return axes[0].point;
  if (metrology::angleBetween(axes[first - 1], axes[first]) < metrology::kNearParallel)
    return metrology::nearestPoint(axes[first], hayatiPoint(axes, first - 1));
  return metrology::commonPerpendicular(axes[first - 1], axes[first]).foot_on_second;
}

Links linkGeometry(const robot::Robot& nominal, const ArmInR0& arm) {
  Links links(nominal.axes_in_base_at_zero.size() - 1);
  const auto& actual = arm.arm.axes_in_base_at_zero;
  const auto& urdf = nominal.axes_in_base_at_zero;
  for (std::size_t i = 0; i < links.size(); ++i) {
    LinkGeometry& link = links[i];
    link.angle = metrology::angleBetween(actual[i], actual[i + 1]);
    link.nominal_angle = metrology::angleBetween(urdf[i], urdf[i + 1]);
    link.near_parallel = link.nominal_angle < metrology::kNearParallel;
    if (link.near_parallel) {
      link.at_point_in_r0 = hayatiPoint(actual, i);
      link.distance = metrology::distanceAcross(actual[i], actual[i + 1], link.at_point_in_r0);
      link.nominal_distance = metrology::distanceAcross(urdf[i], urdf[i + 1], hayatiPoint(urdf, i));
    } else {
      link.distance = metrology::commonPerpendicular(actual[i], actual[i + 1]).distance;
      link.nominal_distance = metrology::commonPerpendicular(urdf[i], urdf[i + 1]).distance;
    }
  }
  return links;
}

}  // namespace stiffscope::frames
