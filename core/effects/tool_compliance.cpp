#include <algorithm>

#include "core/effects/all.h"

namespace stiffscope::effects {

// The plate between flange and reflectors gives: rotation about the flange origin about its three axes by
// the moment there, shift along them by the force, in flange axes. Either of the load and of what hangs on
// the flange, or of the load alone, where the tool's weight does not go through the plate. The turn about
// the last axis is that joint's own compliance where both axes agree. rad/Nm and m/N, never negative; turns of at most
// 1e-4 rad/Nm, or forty times what the arm gives as a whole if that is more.

namespace {

std::vector<BodyTwist> byWrench(const ArmState& state, const robot::Wrench& load) {
  std::vector<BodyTwist> twists(6, {.first_body = toolBody(state.bodies()), .pivot = state.flange.translation()});
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = state.flange.linear().col(k);
    twists[static_cast<std::size_t>(k)].rotation = axis * axis.dot(load.moment);
    twists[static_cast<std::size_t>(3 + k)].shift = axis * axis.dot(load.force);
  }
  return twists;
}

std::vector<BodyTwist> withWeight(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  return byWrench(posture[i], carried(posture[i], posture[i].bodies(), posture[i].flange.translation()));
}

std::vector<BodyTwist> byLoad(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  return byWrench(posture[i], posture[i].load.about(posture[i].flange.translation()));
}

EffectModel modelOf(const char* shape, decltype(EffectModel::twists) twists, const ModelScope& scope) {
  const double most_turn = std::max(1e-4, 40.0 * scope.compliance);
  EffectModel model{.shape = shape, .most_parts = 6, .twists = twists, .beyond_flange = true};
  for (const char* name : {"bending about x", "bending about y", "twist about z"})
    model.parts.push_back({.detail = name, .most = {most_turn}, .positive = true, .unit = "rad/Nm", .alike = 1});
  for (const char* name : {"shift along x", "shift along y", "shift along z"})
    model.parts.push_back({.detail = name, .most = {1e-5}, .positive = true, .unit = "m/N", .alike = 2});
  return model;
}

Remark toolComplianceMissing(const CampaignContents& has) {
  if (has.reflectors < 2 && !has.moments) return Remark(RemarkId::tool_needs_reflectors_or_moments);
  return {};
}

std::vector<EffectModel> toolComplianceModels(const ModelScope& scope) {
  return {modelOf("by the load and what hangs on the flange", &withWeight, scope),
          modelOf("by the load alone", &byLoad, scope)};
}

}  // namespace

const EffectRecord& toolCompliance() {
  static const EffectRecord record{.effect = Effect::tool_compliance,
                                   .nature = EffectNature::machine,
                                   .missing = &toolComplianceMissing,
                                   .models = &toolComplianceModels};
  return record;
}

}  // namespace stiffscope::effects
