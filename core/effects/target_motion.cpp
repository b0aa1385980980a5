#include "core/effects/target_motion.h"

#include <algorithm>

namespace stiffscope::effects {

namespace {

/// The same field, in R0, for whichever reflector it is: one block of columns each.
Eigen::MatrixXd forEach(const WorkingPoint& at, const ArmState& state,
                        const Eigen::Matrix<double, 3, Eigen::Dynamic>& field) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), field.cols() * at.targets);
  for (std::size_t t = 0; t < state.points.size(); ++t) {
    columns.block(3 * static_cast<Eigen::Index>(t), field.cols() * state.targets[t], 3, field.cols()) = field;
  }
  return columns;
}

/// The reflector slips once the force has passed this share of the campaign's largest, and stays there.
template <int kPercent>
Eigen::MatrixXd lastingFrom(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  double largest = 0.0;
  for (std::size_t k = 1; k <= i; ++k) largest = std::max(largest, posture[k].load.force.norm());
  const double slipped = largest > 0.01 * kPercent * at.largest_force ? 1.0 : 0.0;
  return forEach(at, posture[i], slipped * posture[i].flange.linear());
}

/// Index of the largest force from the unloaded state to state `last`; 0 before the first load.
std::size_t largestSoFar(const PostureStates& posture, std::size_t last) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k <= last; ++k) {
    if (posture[k].loaded && posture[k].load.force.norm() > posture[largest].load.force.norm()) largest = k;
  }
  return largest;
}

Eigen::MatrixXd proportional(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  return forEach(at, state, state.load.force.norm() / at.largest_force * state.flange.linear());
}

Eigen::MatrixXd step(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  return forEach(at, posture[i], (posture[i].loaded ? 1.0 : 0.0) * posture[i].flange.linear());
}

Eigen::MatrixXd lasting(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const double slipped = largestSoFar(posture, i) > 0 ? 1.0 : 0.0;
  return forEach(at, posture[i], slipped * posture[i].flange.linear());
}

Eigen::MatrixXd spring(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Eigen::Matrix3d axes = posture[i].flange.linear();
  const Eigen::Vector3d f = axes.transpose() * posture[i].load.force / at.largest_force;
  Eigen::Matrix<double, 3, 6> by_entry;
  by_entry << f.x(), 0, 0, f.y(), f.z(), 0,  //
      0, f.y(), 0, f.x(), 0, f.z(),          //
      0, 0, f.z(), 0, f.x(), f.y();
  return forEach(at, posture[i], axes * by_entry);
}

Eigen::MatrixXd pulledAlong(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  return forEach(at, posture[i], posture[largestSoFar(posture, i)].load.force / at.largest_force);
}

EffectModel modelOf(const std::vector<std::string>& targets, const char* shape, std::size_t parameters,
                    decltype(EffectModel::offset) offset) {
  constexpr double kMost = 5e-3;  // m: a reflector further out would have left its nest
  EffectModel model{Effect::target_motion, shape, {}, 1, offset, nullptr};
  for (const std::string& target : targets)
    model.parts.push_back({target, std::vector<double>(parameters, kMost), false, "m"});
  return model;
}

}  // namespace

EffectModel targetMotion(const std::vector<std::string>& targets) {
  return modelOf(targets, "in proportion to the load", 3, &proportional);
}

EffectModel targetSlip(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a step under load", 3, &step);
}

EffectModel targetLastingSlip(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a slip that stays", 3, &lasting);
}

EffectModel targetSlipFromHalf(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a slip beyond half the load that stays", 3, &lastingFrom<50>);
}

EffectModel targetSlipAtFull(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a slip near the full load that stays", 3, &lastingFrom<80>);
}

EffectModel targetNestSpring(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a spring of the nest", 6, &spring);
}

EffectModel targetPulledAlong(const std::vector<std::string>& targets) {
  return modelOf(targets, "by a slip along the pull that stays", 1, &pulledAlong);
}

}  // namespace stiffscope::effects
