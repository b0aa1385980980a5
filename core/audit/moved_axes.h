#pragma once

#include <array>

#include "core/frames/frames.h"
#include "metrology/measured_line.h"

namespace stiffscope {

/// The six swept axes in R0, each with the covariance of its four parameters, and the arm with one of these
/// moved: how a model's prediction hangs on what the sweeps leave open. Only meant for axes that were
/// measured.
class MovedAxes {
 public:
  explicit MovedAxes(const Frames& frames);

  /// 4x4, of axis `axis` (0-based).
  const Eigen::Matrix4d& covariance(std::size_t axis) const { return axes_[axis].covariance; }

  /// Posture of `arm` at `q` with parameter 0..3 of an axis moved by kStep.
  ArmPosture postureWithMoved(const Robot& arm, const Vector6d& q, std::size_t axis, int parameter) const;

  static constexpr double kStep = 1e-6;  ///< m and rad: far above rounding, far below where the model curves

 private:
  std::array<MeasuredLine, 6> axes_;
};

}  // namespace stiffscope
