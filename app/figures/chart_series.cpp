#include "app/figures/chart_series.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace stiffscope::app {

Eigen::Matrix3d beamDirections(const Eigen::Vector3d& station, const Eigen::Vector3d& point) {
  const Eigen::Vector3d beam = (point - station).normalized();
  Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(beam);
  level = level.norm() > 1e-9 ? level.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  Eigen::Matrix3d directions;
  directions << beam, level, beam.cross(level);
  return directions;
}

render::PointSeries meansOver(const std::vector<render::PlotPoint>& points, double lower, double upper,
                              std::size_t count) {
  constexpr std::size_t kLeast = 5;  // a mean of fewer readings says little
  std::vector<double> sum(count, 0.0);
  std::vector<std::size_t> readings(count, 0);
  const double width = (upper - lower) / static_cast<double>(count);
  for (const render::PlotPoint& point : points) {
    const double place = width > 0.0 ? std::max(0.0, (point.x - lower) / width) : 0.0;
    const auto at = std::min(count - 1, static_cast<std::size_t>(place));
    sum[at] += point.y;
    ++readings[at];
  }
  render::PointSeries means;
  means.colour = render::colours::kInk;
  means.mark = render::PointMark::none;
  means.joined = true;
  for (std::size_t i = 0; i < count; ++i) {
    if (readings[i] >= kLeast)
      means.points.push_back(
          {lower + (static_cast<double>(i) + 0.5) * width, sum[i] / static_cast<double>(readings[i])});
  }
  return means;
}

}  // namespace stiffscope::app
