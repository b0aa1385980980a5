#include "core/simulation/equilibrium.h"

#include <cmath>
#include <numbers>

#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

int loadSteps(const LoadingSpec& loading) {
  const auto* weights = std::get_if<HangingWeights>(&loading.load);
  const std::size_t loaded = weights ? weights->masses_kg.size() : std::get<CablePull>(loading.load).tensions.size();
  return static_cast<int>(loaded) + (loading.return_to_zero ? 1 : 0);
}

AppliedLoad loadAtStep(const LoadingSpec& loading, int step, const Eigen::Vector3d& gravity_in_base,
                       const std::optional<Eigen::Vector3d>& pull_direction, const Eigen::Vector3d& unread) {
  if (step == 0) return {};
  const std::size_t index = static_cast<std::size_t>(step) - 1;
  if (const auto* weights = std::get_if<HangingWeights>(&loading.load)) {
    if (index >= weights->masses_kg.size()) return {};
    return DeadForce{loading.hook_in_flange, weights->masses_kg[index] * gravity_in_base, unread};
  }
  const auto& cable = std::get<CablePull>(loading.load);
  if (index >= cable.tensions.size()) return {};
  if (cable.anchor) return AnchoredCable{loading.hook_in_flange, *cable.anchor, cable.tensions[index], unread};
  const Eigen::Vector3d direction =
      pull_direction ? *pull_direction : cable.direction.value_or(Eigen::Vector3d::Zero());
  return DeadForce{loading.hook_in_flange, cable.tensions[index] * direction, unread};
}

AppliedLoad swungLoad(const LoadingSpec& loading, const AppliedLoad& load, double time_s) {
  const auto* weight = std::get_if<DeadForce>(&load);
  if (weight == nullptr || loading.swing == 0.0) return load;
  const double angle = loading.swing * std::sin(2.0 * std::numbers::pi * time_s / loading.swing_period);
  DeadForce swung = *weight;
  swung.force_in_base = rotationExp(angle * Eigen::Vector3d::UnitX()) * weight->force_in_base;
  return swung;
}

Eigen::Vector3d loadPointInFlange(const AppliedLoad& load) {
  if (const auto* force = std::get_if<DeadForce>(&load)) return force->point_in_flange;
  if (const auto* cable = std::get_if<AnchoredCable>(&load)) return cable->point_in_flange;
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d loadForce(const AppliedLoad& load, const Eigen::Vector3d& point_in_base) {
  if (const auto* force = std::get_if<DeadForce>(&load)) return force->force_in_base + force->unread_in_base;
  if (const auto* cable = std::get_if<AnchoredCable>(&load)) {
    return cable->tension * (cable->anchor_in_base - point_in_base).normalized() + cable->unread_in_base;
  }
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d unreadForce(const AppliedLoad& load) {
  if (const auto* force = std::get_if<DeadForce>(&load)) return force->unread_in_base;
  if (const auto* cable = std::get_if<AnchoredCable>(&load)) return cable->unread_in_base;
  return Eigen::Vector3d::Zero();
}

double loadPotential(const AppliedLoad& load, const Eigen::Vector3d& point_in_base) {
  if (std::holds_alternative<DeadForce>(load)) return -loadForce(load, point_in_base).dot(point_in_base);
  if (const auto* cable = std::get_if<AnchoredCable>(&load)) {
    return cable->tension * (cable->anchor_in_base - point_in_base).norm() - cable->unread_in_base.dot(point_in_base);
  }
  return 0.0;
}

}  // namespace stiffscope::simulation
