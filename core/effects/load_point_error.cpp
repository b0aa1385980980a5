#include "core/effects/all.h"

namespace stiffscope::effects {

// The load acts elsewhere on the tool than declared: its point is off by r in flange axes, which changes the
// moment by (R r) x F; the springs turn accordingly. r in m, at most 0.3 m each way. Bilinear with the
// compliances.

namespace {

Eigen::MatrixXd loadPointErrorOffset(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns(state.rows(), 3);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d moment = state.flange.linear().col(k).cross(state.load.force);
    columns.col(k) = bySprings(at, state, {state.load.point, Eigen::Vector3d::Zero(), moment});
  }
  return columns;
}

void loadPointErrorCorrect(const JointVector&, LinearizationPoint&, Corrections& corrections, Eigen::VectorXd& own) {
  corrections.load_point = own;
}

std::vector<EffectModel> loadPointErrorModels(const ModelScope&) {
  return {{.parts = {{"", {0.3, 0.3, 0.3}, false, "m", {"x", "y", "z"}}},
           .offset = &loadPointErrorOffset,
           .correct = &loadPointErrorCorrect}};
}

}  // namespace

const EffectRecord& loadPointError() {
  static const EffectRecord record{
      .effect = Effect::load_point_error, .nature = EffectNature::load, .models = &loadPointErrorModels};
  return record;
}

}  // namespace stiffscope::effects
