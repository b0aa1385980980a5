#include "core/diagnosis/effects/target_motion.h"

namespace stiffscope {

namespace {

Eigen::MatrixXd moved(const WorkingPoint& at, const ArmState& state, double share) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), 3 * at.targets);
  for (std::size_t t = 0; t < state.points.size(); ++t) {
    columns.block<3, 3>(3 * static_cast<Eigen::Index>(t), 3 * state.targets[t]) = share * state.flange.linear();
  }
  return columns;
}

Eigen::MatrixXd proportional(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  return moved(at, posture[i], posture[i].load.force.norm() / at.largest_force);
}

Eigen::MatrixXd step(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  return moved(at, posture[i], posture[i].loaded ? 1.0 : 0.0);
}

EffectModel modelOf(const std::vector<std::string>& targets, const char* shape, decltype(EffectModel::offset) offset) {
  EffectModel model{Effect::target_motion, shape, {}, 1, offset, nullptr};
  for (const std::string& target : targets) model.parts.push_back({target, {5e-3, 5e-3, 5e-3}, false, "m"});
  return model;
}

}  // namespace

EffectModel targetMotion(const std::vector<std::string>& targets) {
  return modelOf(targets, "in proportion to the load", &proportional);
}

EffectModel targetSlip(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a step under load", &step);
}

}  // namespace stiffscope
