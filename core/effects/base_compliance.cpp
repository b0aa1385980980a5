#include "core/effects/all.h"

namespace stiffscope::effects {

// Pedestal or floor gives: rotation about the two horizontal axes of base_link through its origin by the
// moment there, and shifts along its three axes by the force (own weight and load). Its turn about the
// vertical is joint 1's own compliance. Parameters: rocking about x, about y (rad/Nm), shift along x, y, z
// (m/N); never negative.

namespace {

std::vector<BodyTwist> baseComplianceTwists(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const Eigen::Vector3d foot = at.r0_from_base_link.translation();
  const Eigen::Matrix3d axes = at.r0_from_base_link.linear();
  const robot::Wrench load = carried(posture[i], 1, foot);
  std::vector<BodyTwist> twists(5, {.first_body = 1, .with_axis = true, .pivot = foot});
  for (int k = 0; k < 2; ++k) twists[static_cast<std::size_t>(k)].rotation = axes.col(k) * axes.col(k).dot(load.moment);
  for (int k = 0; k < 3; ++k) twists[static_cast<std::size_t>(2 + k)].shift = axes.col(k) * axes.col(k).dot(load.force);
  return twists;
}

std::vector<EffectModel> baseComplianceModels(const ModelScope&) {
  EffectModel model{.most_parts = 5, .twists = &baseComplianceTwists};
  for (const char* name : {"rocking about x", "rocking about y"}) model.parts.push_back({name, {1e-5}, true, "rad/Nm"});
  for (const char* name : {"shift along x", "shift along y", "shift along z"})
    model.parts.push_back({name, {1e-5}, true, "m/N"});
  return {model};
}

}  // namespace

const EffectRecord& baseCompliance() {
  static const EffectRecord record{
      .effect = Effect::base_compliance, .nature = EffectNature::machine, .models = &baseComplianceModels};
  return record;
}

}  // namespace stiffscope::effects
