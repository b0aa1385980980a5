#pragma once

#include <Eigen/Core>
#include <vector>

#include "metrology/line.h"

namespace stiffscope {

/// The arc that points cover about an axis: 2 pi less the largest gap between neighbouring points (rad), so that
/// a full turn of n even stops gives 2 pi (n-1)/n. 0 for fewer than two points.
double sweptArc(const Line& axis, const std::vector<Eigen::Vector3d>& points);

}  // namespace stiffscope
