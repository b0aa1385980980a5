#pragma once

#include <string>
#include <vector>

#include "core/extended_model/fitted_effects.h"

namespace stiffscope::extended_model {

/// How far the fitted effects move reflectors, in R0, m: state by state of one posture, own weight's part included.
class PostureOffsets {
 public:
  /// Of effects of the machine where `machine`, and of what shifts readings where `readings`.
  struct Which {
    bool machine = true, readings = true;
  };

  PostureOffsets(const EffectFit& effects, const Eigen::VectorXd& parameters, const effects::PostureStates& posture,
                 Which which);

  /// Of a reflector that stands at `place` unloaded, one a state. The machine's part is the difference between where
  /// the arm with its effects stands and where joint springs alone would have it (ElasticArm), readings' the fit's own
  /// linear model.
  std::vector<Eigen::Vector3d> of(int target, const Eigen::Vector3d& place) const;

 private:
  std::vector<Eigen::Vector3d> linear(int target, const Eigen::Vector3d& place, bool machine) const;
  std::vector<Eigen::Vector3d> byMachine(const Eigen::Vector3d& place) const;

  const EffectFit& effects_;
  const Eigen::VectorXd& parameters_;
  const effects::PostureStates& posture_;
  Which which_;
  /// Motion of the tool with the effects and by springs alone; empty where some state does not come to rest.
  std::vector<Eigen::Isometry3d> with_, without_;
};

struct ShiftOptions {
  PostureOffsets::Which which;
  Vector6d frame = Vector6d::Zero();  ///< of the loading: its motion (as frameError has it) is undone first
  bool sweeps = true;                 ///< false: the sweeps stay as they are
};

/// Takes what the effects add (PostureOffsets) off every reading of loading, displacements and, where they took part in
/// the fit, sweeps.
void shiftReadings(const EffectFit& effects, const Eigen::VectorXd& parameters, const ShiftOptions& options,
                   campaign::Campaign& campaign);

enum class TakenOff {
  everything,   ///< what is left is the day of a machine with joint springs and nothing else
  loads,        ///< the same, of the loading alone: the sweeps stay as they are
  measurement,  ///< only what the machine does not do, of the loading: its deflections are then the true ones
};

/// The campaign as it would have been read without the effects, at the given size of their parameters (as
/// EffectFit::parameters). Off every reading of loading, displacements and, where they took part in the fit, sweeps
/// goes what the effects add in its state, own weight's part included. Effects that act through the wrench change the
/// load cell's declared point (load_point_error) or the readings in `states` (misalignment, bias); a moved frame is
/// undone by its finite motion.
///
/// Postures whose loaded readings the fit does not have (no reflector read in all load steps) cannot be corrected and
/// are left out, named in `left_out`. Throws InputError where the load cell's point does not move with the flange and
/// is to be corrected.
campaign::Campaign withoutEffects(const campaign::Campaign& campaign, const EffectFit& effects,
                                  const Eigen::VectorXd& parameters, TakenOff which,
                                  std::vector<identification::LeftOutPosture>* left_out = nullptr);

}  // namespace stiffscope::extended_model
