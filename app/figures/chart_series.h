#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/point_chart.h"

namespace stiffscope::app {

/// Directions a tracker sees a point in, as columns: along the beam from `station`, across it level (to z), across it
/// upright.
Eigen::Matrix3d beamDirections(const Eigen::Vector3d& station, const Eigen::Vector3d& point);

/// Means of y over `count` equal parts of [lower, upper] in x, joined; parts with too few points for a mean are left
/// out.
render::PointSeries meansOver(const std::vector<render::PlotPoint>& points, double lower, double upper,
                              std::size_t count);

}  // namespace stiffscope::app
