#include "metrology/axis_frame.h"

namespace stiffscope {

AxisFrame::AxisFrame(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
  axis_.line = {point, direction.normalized()};
  setBasis();
}

void AxisFrame::setBasis() {
  basisAcross(axis_.line.direction, axis_.across_u, axis_.across_v);
  long double square = 0.0L;
  for (int k = 0; k < 3; ++k)
    square += static_cast<long double>(axis_.line.direction[k]) * axis_.line.direction[k];
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

}  // namespace stiffscope
