#include "core/effects/load_point_error.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns(state.rows(), 3);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d moment = state.flange.linear().col(k).cross(state.load.force);
    columns.col(k) = bySprings(at, state, {state.load.point, Eigen::Vector3d::Zero(), moment});
  }
  return columns;
}

}  // namespace

EffectModel loadPointError() {
  return {Effect::load_point_error, "", {{"", {0.3, 0.3, 0.3}, false, "m"}}, 1, &offset, nullptr};
}

}  // namespace stiffscope::effects
