#include "core/effects/all.h"

#include <fmt/format.h>

namespace stiffscope::effects {

// A link bends and twists along its length: a straight beam from one joint origin to the next, clamped at
// the inner end, loaded at the outer one by F, M (own weight beyond it and load). Euler-Bernoulli, round
// section: deflection F_t L^3/3EI + M_t x e L^2/2EI, slope e x F_t L^2/2EI + M_t L/EI, twist M_e L/GJ; e
// along the beam. Parameters of each link: 1/EI and 1/GJ, 1/(N m^2), never negative; at most 1e-4 (a steel
// tube of 40 mm).

namespace {

/// Links 1 to 4 of six joints: from the joint's own axis to the next axis; the wrist's own bodies are compact.
constexpr int linksOf(int joints) { return robot::armJointsOf(joints) + 1; }

std::vector<BodyTwist> linkComplianceTwists(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  std::vector<BodyTwist> twists;
  twists.reserve(2 * static_cast<std::size_t>(linksOf(posture[i].joints())));
  for (int link = 0; link < linksOf(posture[i].joints()); ++link) {
    const int axis = posture[i].axes.axisOf(link);
    const Eigen::Vector3d from = posture[i].axes[static_cast<std::size_t>(axis)].point;
    const Eigen::Vector3d tip = posture[i].axes[static_cast<std::size_t>(axis) + 1].point;
    const double length = (tip - from).norm();
    BodyTwist bending{.first_body = axis + 2, .with_axis = true, .pivot = tip}, torsion = bending;
    constexpr double kNoBeam = 0.05;  // m: shorter is a housing
    if (length >= kNoBeam) {
      const Eigen::Vector3d along = (tip - from) / length;
      const robot::Wrench load = carried(posture[i], axis + 2, tip);
      const Eigen::Vector3d force = load.force - along * along.dot(load.force);
      const Eigen::Vector3d moment = load.moment - along * along.dot(load.moment);
      const double square = length * length;
      bending.rotation = square / 2.0 * along.cross(force) + length * moment;
      bending.shift = square * length / 3.0 * force + square / 2.0 * moment.cross(along);
      torsion.rotation = length * along * along.dot(load.moment);
    }
    twists.push_back(bending);
    twists.push_back(torsion);
  }
  return twists;
}

std::vector<EffectModel> linkComplianceModels(const ModelScope& scope) {
  const int links = linksOf(scope.joints);
  EffectModel model{.most_parts = static_cast<std::size_t>(links), .twists = &linkComplianceTwists};
  for (int link = 1; link <= links; ++link) {
    const std::string name = fmt::format("link {}", link);
    model.parts.push_back({.detail = name,
                           .most = {1e-4, 1e-4},
                           .positive = true,
                           .unit = "1/(N m^2)",
                           .names = {"1/EI of " + name, "1/GJ of " + name},
                           .alike = link});
  }
  return {model};
}

}  // namespace

const EffectRecord& linkCompliance() {
  static const EffectRecord record{
      .effect = Effect::link_compliance, .nature = EffectNature::machine, .models = &linkComplianceModels};
  return record;
}

}  // namespace stiffscope::effects
