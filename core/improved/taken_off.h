#pragma once

#include <string>
#include <vector>

#include "core/improved/effect_fit.h"

namespace stiffscope {

enum class TakenOff {
  everything,   ///< what is left is the day of a machine with joint springs and nothing else
  measurement,  ///< only what the machine does not do: the deflections are then the true ones
};

/// The campaign as it would have been read without the effects, at the given size of their parameters
/// (EffectFit::parameters). Off every reading of loading, displacements and, where they took part in the fit, sweeps goes
/// the offset u = columns * theta of its state, own weight's part included, at the place where the reflector stood
/// unloaded; first order in the offset, a micrometre at most for offsets of a millimetre. Effects that act through the
/// wrench change the load cell's declared point (load_point_error) or the readings in `states` (misalignment, bias); a
/// moved frame is undone by its finite motion.
///
/// Postures whose loaded readings the fit does not have (no reflector read in all load steps) cannot be corrected and are
/// left out, named in `left_out`.
Campaign withoutEffects(const Campaign& campaign, const EffectFit& effects, const Eigen::VectorXd& parameters,
                        TakenOff which, std::vector<std::string>* left_out = nullptr);

}  // namespace stiffscope
