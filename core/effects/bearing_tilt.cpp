#include <algorithm>

#include "core/effects/all.h"

namespace stiffscope::effects {

// A joint also gives about the two directions across its axis (moment compliance of its main bearing, alike
// in both): rotation s (M - z (z.M)) about the joint origin, M what the joint carries there (own weight and
// load), z the axis; of joints' own axes, not of those that only follow. s in rad/Nm, never negative; at most 1e-5, a
// bearing a hundred times softer than a light industrial arm's, or twenty times what the arm gives as a whole if that
// is more: of soft arms the wrist's joints give ten times as much as those that carry the arm, and their bearings may
// as well. Source: bearing catalogues (moment rigidity of crossed-roller and angular bearings).

namespace {

std::vector<BodyTwist> bearingTiltTwists(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  std::vector<BodyTwist> twists;
  twists.reserve(static_cast<std::size_t>(posture[i].joints()));
  for (int j = 0; j < posture[i].joints(); ++j) {
    const int own = posture[i].axes.axisOf(j);
    const metrology::Line& axis = posture[i].axes[static_cast<std::size_t>(own)];
    const Eigen::Vector3d moment = carried(posture[i], own + 1, axis.point).moment;
    const Eigen::Vector3d across = moment - axis.direction * axis.direction.dot(moment);
    twists.push_back({.first_body = own + 1, .pivot = axis.point, .rotation = across});
  }
  return twists;
}

std::vector<EffectModel> bearingTiltModels(const ModelScope& scope) {
  return {{.parts = jointParts(scope, std::max(1e-5, 20.0 * scope.compliance), true, "rad/Nm"),
           .most_parts = static_cast<std::size_t>(scope.joints),
           .twists = &bearingTiltTwists}};
}

}  // namespace

const EffectRecord& bearingTilt() {
  static const EffectRecord record{
      .effect = Effect::bearing_tilt, .nature = EffectNature::machine, .models = &bearingTiltModels};
  return record;
}

}  // namespace stiffscope::effects
