#include <array>
#include <cmath>

#include "core/effects/all.h"

namespace stiffscope::effects {

// Pedestal or floor gives: rotation about the two horizontal axes of base_link through its origin by the
// moment there, and shifts along its three axes by the force (own weight and load). Its turn about the
// vertical is joint 1's own compliance. Of an arm on a rail x is along the rail, so that its shift is what the drive of
// the carriage gives: 1 / (m/N) is the rail's own stiffness. Parameters: rocking about x, about y (rad/Nm), shift along
// x, y, z (m/N); never negative.

Eigen::Matrix3d footAxes(const Eigen::Vector3d& rail_in_base) {
  if (rail_in_base.isZero(0.0)) return Eigen::Matrix3d::Identity();
  const bool upright = std::abs(rail_in_base.z()) > 0.9;  // a lift
  const Eigen::Vector3d across =
      (upright ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ().cross(rail_in_base)).normalized();
  Eigen::Matrix3d axes;
  axes.col(0) = rail_in_base;
  axes.col(2) = rail_in_base.cross(across).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

namespace {

std::vector<BodyTwist> baseComplianceTwists(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const Eigen::Vector3d foot = at.r0_from_base_link.translation();
  const Eigen::Matrix3d axes = at.r0_from_base_link.linear() * footAxes(at.rail_in_base);
  const robot::Wrench load = carried(posture[i], 0, foot);
  std::vector<BodyTwist> twists(5, {.first_body = 1, .with_axis = true, .pivot = foot});
  for (int k = 0; k < 2; ++k) twists[static_cast<std::size_t>(k)].rotation = axes.col(k) * axes.col(k).dot(load.moment);
  for (int k = 0; k < 3; ++k) twists[static_cast<std::size_t>(2 + k)].shift = axes.col(k) * axes.col(k).dot(load.force);
  return twists;
}

std::vector<EffectModel> baseComplianceModels(const ModelScope& scope) {
  EffectModel model{.most_parts = 5, .twists = &baseComplianceTwists};
  const std::array<const char*, 2> rocking = scope.on_rail
                                                 ? std::array{"rocking about the rail", "rocking across the rail"}
                                                 : std::array{"rocking about x", "rocking about y"};
  const std::array<const char*, 3> shift =
      scope.on_rail ? std::array{"shift along the rail", "shift across the rail", "shift off the rail"}
                    : std::array{"shift along x", "shift along y", "shift along z"};
  for (const char* name : rocking) model.parts.push_back({name, {1e-5}, true, "rad/Nm"});
  for (const char* name : shift) model.parts.push_back({name, {1e-5}, true, "m/N"});
  return {model};
}

}  // namespace

const EffectRecord& baseCompliance() {
  static const EffectRecord record{
      .effect = Effect::base_compliance, .nature = EffectNature::machine, .models = &baseComplianceModels};
  return record;
}

}  // namespace stiffscope::effects
