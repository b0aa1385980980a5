#pragma once

#include <string>
#include <vector>

#include "core/improved/fitted_effects.h"

namespace stiffscope {

enum class TakenOff {
  everything,   ///< what is left is the day of a machine with joint springs and nothing else
  loads,        ///< the same, of the loading alone: the sweeps stay as they are
  measurement,  ///< only what the machine does not do, of the loading: its deflections are then the true ones
};

/// The campaign as it would have been read without the effects, at the given size of their parameters (as
/// EffectFit::parameters). Off every reading of loading, displacements and, where they took part in the fit, sweeps goes
/// what the effects add in its state, own weight's part included (effect_offsets.h). Effects that act through the
/// wrench change the load cell's declared point (load_point_error) or the readings in `states` (misalignment, bias); a
/// moved frame is undone by its finite motion.
///
/// Postures whose loaded readings the fit does not have (no reflector read in all load steps) cannot be corrected and are
/// left out, named in `left_out`. Throws InputError where the load cell's point does not move with the flange and is to be
/// corrected.
Campaign withoutEffects(const Campaign& campaign, const EffectFit& effects, const Eigen::VectorXd& parameters,
                        TakenOff which, std::vector<std::string>* left_out = nullptr);

}  // namespace stiffscope
