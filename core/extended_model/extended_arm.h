#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/extended_model/fitted_effects.h"

namespace stiffscope::extended_model {

/// A load that keeps its force and moment in R0 and acts at a point fixed to the tool.
struct ToolLoad {
  Eigen::Vector3d point_at_zero = Eigen::Vector3d::Zero();  ///< where the point stands in R0 at all joints zero, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< R0 axes, N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();         ///< R0 axes, about the point, Nm
};

/// The arm on its joint springs and with what the fitted effects of the machine add, at rest, finite rotations: joint
/// springs turn by c tau plus the angles of effects that turn joints; a bearing's tilt, a link's tip and the base move
/// what lies beyond them, the plate the tool. Each by the effect's own equation (core/effects), its moments
/// and axes taken where the deflected arm has them, so that what one gives changes what the others carry; found by
/// fixed-point iteration to 1e-10 rad, a contraction of a hundredth a step.
class ImprovedArm {
 public:
  /// `parameters` as EffectFit::parameters; all zero: joint springs alone. `effects` and `geometry` must outlive the arm.
  ImprovedArm(const EffectFit& effects, const Eigen::VectorXd& parameters, const frames::LoadingGeometry& geometry,
              const Vector6d& compliance);

  /// Motion of the tool (what lies beyond the plate; without one, the flange) from its place at all joints zero, in state
  /// `s` of a posture: its q, its history of loads, whether it is loaded. `load` acts there; null: the own weight
  /// alone. Empty where the arm does not come to rest.
  std::optional<Eigen::Isometry3d> toolMotion(const effects::PostureStates& posture, std::size_t s, const ToolLoad* load) const;

 private:
  struct Give;
  Give giveOf(const effects::PostureStates& posture, std::size_t s) const;

  const EffectFit& effects_;
  const frames::LoadingGeometry& geometry_;
  Vector6d compliance_;
  std::vector<std::pair<const effects::EffectModel*, Eigen::VectorXd>> machine_;  ///< effects of the machine, with their sizes
};

}  // namespace stiffscope::extended_model
