#pragma once

#include <vector>

#include "core/effects/elastic_arm.h"
#include "core/extended_model/fitted_effects.h"

namespace stiffscope::extended_model {

/// How far the fitted effects move reflectors, in R0, m: state by state of one posture, own weight's part included.
class PostureOffsets {
 public:
  /// Which effects count: of the machine where `machine`, those that shift readings where `readings`.
  struct Which {
    bool machine = true, readings = true;
  };

  PostureOffsets(const EffectFit& effects, const effects::PostureStates& posture, Which which);

  /// Offsets of a reflector that is at `place` unloaded, one a state. The machine's part is the difference between
  /// where the arm with its effects stands and where joint springs alone would have it (ElasticArm), readings' the
  /// fit's own linear model.
  std::vector<Eigen::Vector3d> of(int target, const Eigen::Vector3d& place) const;

 private:
  std::vector<Eigen::Vector3d> linear(int target, const Eigen::Vector3d& place, bool machine) const;
  std::vector<Eigen::Vector3d> byMachine(const Eigen::Vector3d& place) const;

  const EffectFit& effects_;
  const effects::PostureStates& posture_;
  Which which_;
  /// Motion of the tool with the effects and by springs alone; empty where some state does not come to rest.
  std::vector<Eigen::Isometry3d> with_, without_;
};

/// Parameters of effects as the linear system counts them: models of its input, and rows of the vector of all effects'
/// parameters.
struct EffectColumns {
  std::vector<std::size_t> models;
  std::vector<Eigen::Index> parameters;
};

/// The fitted ones: EffectFit::free.
EffectColumns columnsOf(const EffectFit& effects);

/// Displacement of reflectors in a loaded state by a unit of each of the parameters, to first order where the fit
/// stands: 3 rows a reflector in the order of `targets`, which stand at `places` unloaded. R0, m per unit.
Eigen::MatrixXd displacementByEffects(const diagnosis::SystemInput& input, const diagnosis::GapFit& fit,
                                      const EffectColumns& columns, const effects::PostureStates& posture,
                                      std::size_t state, const std::vector<int>& targets,
                                      const std::vector<Eigen::Vector3d>& places);

/// Displacements at joint angles q (rad) under a load that the day need not have measured, by each column of `steps`
/// (of EffectFit::free): of reflectors that stand at `targets_in_flange`, of the campaign's in their order. R0, m.
Eigen::MatrixXd displacementBySteps(const EffectFit& effects, const Eigen::MatrixXd& steps, const JointVector& q,
                                    const effects::FlangeLoad& load,
                                    const std::vector<Eigen::Vector3d>& targets_in_flange);

}  // namespace stiffscope::extended_model
