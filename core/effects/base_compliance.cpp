#include "core/effects/base_compliance.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  const Eigen::Vector3d foot = at.r0_from_base_link.translation();
  const Eigen::Matrix3d axes = at.r0_from_base_link.linear();
  const robot::Wrench load = carried(state, 1, foot);
  Eigen::MatrixXd columns(state.rows(), 5);
  for (int k = 0; k < 2; ++k) {
    columns.col(k) =
        byMotion(state, foot, axes.col(k) * axes.col(k).dot(load.moment), Eigen::Vector3d::Zero());
  }
  for (int k = 0; k < 3; ++k) {
    columns.col(2 + k) =
        byMotion(state, foot, Eigen::Vector3d::Zero(), axes.col(k) * axes.col(k).dot(load.force));
  }
  return columns;
}

}  // namespace

EffectModel baseCompliance() {
  EffectModel model{Effect::base_compliance, "", {}, 5, &offset, nullptr};
  for (const char* name : {"rocking about x", "rocking about y"}) {
    model.parts.push_back({name, {1e-5}, true, "rad/Nm"});
  }
  for (const char* name : {"shift along x", "shift along y", "shift along z"}) {
    model.parts.push_back({name, {1e-5}, true, "m/N"});
  }
  model.first_body.assign(5, 1);
  return model;
}

}  // namespace stiffscope::effects
