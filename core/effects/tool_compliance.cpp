#include "core/effects/tool_compliance.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd byWrench(const ArmState& state, const robot::Wrench& load) {
  const Eigen::Vector3d origin = state.flange.translation();
  const Eigen::Matrix3d axes = state.flange.linear();
  Eigen::MatrixXd columns(state.rows(), 6);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = axes.col(k);
    columns.col(k) = byMotion(state, origin, axis * axis.dot(load.moment), Eigen::Vector3d::Zero());
    columns.col(3 + k) = byMotion(state, origin, Eigen::Vector3d::Zero(), axis * axis.dot(load.force));
  }
  return columns;
}

Eigen::MatrixXd withWeight(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  return byWrench(posture[i], carried(posture[i], 6, posture[i].flange.translation()));
}

Eigen::MatrixXd byLoad(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  return byWrench(posture[i], posture[i].load.about(posture[i].flange.translation()));
}

EffectModel modelOf(const char* shape, decltype(EffectModel::offset) offset) {
  EffectModel model{Effect::tool_compliance, shape, {}, 6, offset, nullptr};
  for (const char* name : {"bending about x", "bending about y", "twist about z"}) {
    model.parts.push_back({name, {1e-4}, true, "rad/Nm"});
  }
  for (const char* name : {"shift along x", "shift along y", "shift along z"}) {
    model.parts.push_back({name, {1e-5}, true, "m/N"});
  }
  return model;
}

}  // namespace

EffectModel toolCompliance() { return modelOf("by the load and what hangs on the flange", &withWeight); }

EffectModel toolComplianceByLoad() { return modelOf("by the load alone", &byLoad); }

}  // namespace stiffscope::effects
