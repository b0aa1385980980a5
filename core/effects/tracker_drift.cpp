#include "core/effects/tracker_drift.h"

#include <cmath>

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), 6);
  if (!std::isfinite(state.time_s)) return columns;
  const double since = (state.time_s - at.sweep_time) / at.time_span;
  for (int k = 0; k < 3; ++k) {
    columns.col(k) =
        since * byMotion(state, at.epoch_centre, Eigen::Vector3d::Unit(k), Eigen::Vector3d::Zero());
    columns.col(3 + k) =
        since * byMotion(state, at.epoch_centre, Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(k));
  }
  return columns;
}

}  // namespace

EffectModel trackerDrift() {
  return {Effect::tracker_drift,
          "",
          {{"", {0.05, 0.05, 0.05, 0.05, 0.05, 0.05}, false, "rad, m"}},
          1,
          &offset,
          nullptr};
}

}  // namespace stiffscope::effects
