#pragma once

#include <Eigen/Core>
#include <array>

#include "core/frames/measured_axes.h"

namespace stiffscope {

/// Of the six axes' parameters at zero, four an axis in the order of MeasuredLine, at MeasuredAxis::at_zero. m, rad.
using AxesCovariance = Eigen::Matrix<double, 24, 24>;

/// Law of propagation (GUM 5.2.2) from the fits, which are independent of each other, to the axes at zero, which are
/// not: an axis swept with the joints before it away from zero is turned back about measured axes, and takes part
/// in their errors. Joint angles count as exact. Rows of axes that are not measured are zero.
AxesCovariance axesCovariance(const std::array<MeasuredAxis, 6>& axes);

}  // namespace stiffscope
