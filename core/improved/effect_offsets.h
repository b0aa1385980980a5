#pragma once

#include <vector>

#include "core/improved/fitted_effects.h"

namespace stiffscope {

/// How far the fitted effects move reflectors, in R0, m: state by state of one posture, own weight's part included.
class PostureOffsets {
 public:
  /// Of effects of the machine where `machine`, and of what shifts readings where `readings`.
  struct Which {
    bool machine = true, readings = true;
  };

  PostureOffsets(const EffectFit& effects, const Eigen::VectorXd& parameters, const PostureStates& posture, Which which);

  /// Of a reflector that stands at `place` unloaded, one a state. The machine's part is the difference between where the
  /// arm with its effects stands and where joint springs alone would have it (ImprovedArm), readings' the fit's own
  /// linear model.
  std::vector<Eigen::Vector3d> of(int target, const Eigen::Vector3d& place) const;

 private:
  std::vector<Eigen::Vector3d> linear(int target, const Eigen::Vector3d& place, bool machine) const;
  std::vector<Eigen::Vector3d> byMachine(const Eigen::Vector3d& place) const;

  const EffectFit& effects_;
  const Eigen::VectorXd& parameters_;
  const PostureStates& posture_;
  Which which_;
  /// Motion of the tool with the effects and by springs alone; empty where some state does not come to rest.
  std::vector<Eigen::Isometry3d> with_, without_;
};

}  // namespace stiffscope
