#include "core/effects/bearing_tilt.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns(state.rows(), 6);
  for (int j = 0; j < 6; ++j) {
    const metrology::Line& axis = state.axes[static_cast<std::size_t>(j)];
    const Eigen::Vector3d moment = carried(state, j + 1, axis.point).moment;
    const Eigen::Vector3d across = moment - axis.direction * axis.direction.dot(moment);
    columns.col(j) = byMotion(state, axis.point, across, Eigen::Vector3d::Zero());
  }
  return columns;
}

}  // namespace

EffectModel bearingTilt() {
  EffectModel model{Effect::bearing_tilt, "", jointParts(1e-5, true, "rad/Nm"), 6, &offset, nullptr};
  model.first_body = {1, 2, 3, 4, 5, 6};
  return model;
}

}  // namespace stiffscope::effects
