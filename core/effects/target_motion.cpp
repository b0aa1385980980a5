#include "core/effects/all.h"

#include <algorithm>

namespace stiffscope::effects {

// One reflector moves in its nest under load. Shapes of its shift u, R the flange's axes, f the force on the
// tool in them, F the campaign's largest force (N), u in m, parameters at most 5 mm each way:
//  - in proportion to the load: u = R a |f|/F, three parameters a reflector;
//  - by a step as soon as it is loaded: u = R a, gone without load;
//  - by a slip that stays: u = R a from the first load on, through the return to zero; or only once the
//    force has passed half, or four fifths, of F;
//  - by a spring of the nest: u = R A f/F, A symmetric (xx, yy, zz, xy, xz, yz), six a reflector;
//  - by a slip along the pull that stays: u = a R p/F, p the largest f so far, one a reflector.

namespace {

/// The same field, in R0, for whichever reflector it is: one block of columns each. A reflector that took no part in
/// the fit stands still in its nest.
Eigen::MatrixXd forEach(const LinearizationPoint& at, const ArmState& state,
                        const Eigen::Matrix<double, 3, Eigen::Dynamic>& field) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), field.cols() * at.targets);
  for (std::size_t t = 0; t < state.points.size(); ++t) {
    if (state.targets[t] >= at.targets) continue;
    columns.block(3 * static_cast<Eigen::Index>(t), field.cols() * state.targets[t], 3, field.cols()) = field;
  }
  return columns;
}

/// The reflector slips once the force has passed this share of the campaign's largest, and stays there.
template <int kPercent>
Eigen::MatrixXd lastingFrom(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
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

Eigen::MatrixXd proportional(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  return forEach(at, state, state.load.force.norm() / at.largest_force * state.flange.linear());
}

Eigen::MatrixXd step(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  return forEach(at, posture[i], (posture[i].loaded ? 1.0 : 0.0) * posture[i].flange.linear());
}

Eigen::MatrixXd lasting(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const double slipped = largestSoFar(posture, i) > 0 ? 1.0 : 0.0;
  return forEach(at, posture[i], slipped * posture[i].flange.linear());
}

Eigen::MatrixXd spring(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const Eigen::Matrix3d axes = posture[i].flange.linear();
  const Eigen::Vector3d f = axes.transpose() * posture[i].load.force / at.largest_force;
  Eigen::Matrix<double, 3, 6> by_entry;
  by_entry << f.x(), 0, 0, f.y(), f.z(), 0,  //
      0, f.y(), 0, f.x(), 0, f.z(),          //
      0, 0, f.z(), 0, f.x(), f.y();
  return forEach(at, posture[i], axes * by_entry);
}

Eigen::MatrixXd pulledAlong(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  return forEach(at, posture[i], posture[largestSoFar(posture, i)].load.force / at.largest_force);
}

const std::vector<std::string> kAlongAxes{"x", "y", "z"}, kOfSpring{"xx", "yy", "zz", "xy", "xz", "yz"};

EffectModel modelOf(const std::vector<std::string>& targets, const char* shape,
                    const std::vector<std::string>& parameters, decltype(EffectModel::offset) offset) {
  constexpr double kMost = 5e-3;  // m: a reflector further out would have left its nest
  EffectModel model{.shape = shape, .offset = offset};
  for (const std::string& target : targets) {
    EffectPart part{target, std::vector<double>(std::max<std::size_t>(1, parameters.size()), kMost), false, "m"};
    for (const std::string& one : parameters) part.names.push_back(target + " " + one);
    model.parts.push_back(std::move(part));
  }
  return model;
}

Remark targetMotionMissing(const CampaignContents& has) {
  if (has.reflectors < 3) return Remark(RemarkId::target_needs_three_reflectors);
  return {};
}

std::vector<EffectModel> targetMotionModels(const ModelScope& scope) {
  const std::vector<std::string>& targets = scope.targets;
  return {modelOf(targets, "in proportion to the load", kAlongAxes, &proportional),
          modelOf(targets, "by a step under load", kAlongAxes, &step),
          modelOf(targets, "by a slip that stays", kAlongAxes, &lasting),
          modelOf(targets, "by a slip beyond half the load that stays", kAlongAxes, &lastingFrom<50>),
          modelOf(targets, "by a slip near the full load that stays", kAlongAxes, &lastingFrom<80>),
          modelOf(targets, "by a spring of the nest", kOfSpring, &spring),
          modelOf(targets, "by a slip along the pull that stays", {}, &pulledAlong)};
}

}  // namespace

const EffectRecord& targetMotion() {
  static const EffectRecord record{.effect = Effect::target_motion,
                                   .nature = EffectNature::measurement,
                                   .missing = &targetMotionMissing,
                                   .models = &targetMotionModels};
  return record;
}

}  // namespace stiffscope::effects
