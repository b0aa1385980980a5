#include "core/effects/frame_error.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), 6);
  if (state.pose < 0) return columns;
  for (int k = 0; k < 3; ++k) {
    columns.col(k) = byMotion(state, at.epoch_centre, Eigen::Vector3d::Unit(k), Eigen::Vector3d::Zero());
    columns.col(3 + k) = byMotion(state, at.epoch_centre, Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(k));
  }
  return columns;
}

}  // namespace

EffectModel frameError() {
  return {
      Effect::frame_error, "", {{"", {0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, false, "rad, m"}}, 1, &offset, nullptr};
}

}  // namespace stiffscope::effects
