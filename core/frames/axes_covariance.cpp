#include "core/frames/axes_covariance.h"

#include "metrology/line_derivatives.h"

namespace stiffscope {

namespace {

/// How axis `axis` at zero moves with the axes before it at zero: 4 x 4 axis.
Eigen::MatrixXd byEarlierAxes(const std::array<MeasuredAxis, 6>& axes, std::size_t axis) {
  std::vector<MeasuredLine> earlier;
  for (std::size_t before = 0; before < axis; ++before) earlier.push_back(axes[before].at_zero);
  return derivativesByLines(earlier, [&](const std::vector<Line>& moved) -> Eigen::VectorXd {
    const Line back = turnedBack(moved, axes[axis].swept_at, axes[axis].as_swept.line);
    return axes[axis].at_zero.stepTo(back);
  });
}

}  // namespace

AxesCovariance axesCovariance(const std::array<MeasuredAxis, 6>& axes) {
  AxesCovariance by_fits = AxesCovariance::Zero(), of_fits = AxesCovariance::Zero();
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (!axes[axis].measured) continue;
    const auto at = static_cast<Eigen::Index>(4 * axis);
    of_fits.block<4, 4>(at, at) = axes[axis].as_swept.covariance;
    by_fits.block<4, 4>(at, at).setIdentity();
    const bool turned = (axes[axis].swept_at.head(static_cast<Eigen::Index>(axis)).array() != 0.0).any();
    if (turned) by_fits.middleRows<4>(at) += byEarlierAxes(axes, axis) * by_fits.topRows(at);
  }
  return by_fits * of_fits * by_fits.transpose();
}

}  // namespace stiffscope
