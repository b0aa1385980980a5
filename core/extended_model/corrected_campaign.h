#pragma once

#include <vector>

#include "core/extended_model/fitted_effects.h"
#include "core/identification/load_case.h"

namespace stiffscope::extended_model {

/// The campaign as it would have been read without the effects: what is left is the day of a machine with joint springs
/// and nothing else, which frames, calibration and methods then stand on. Off every reading of loading, displacements
/// and, where they took part in the fit, sweeps goes what the effects add in its state (PostureOffsets), own weight's
/// part included. Effects that act through the wrench change the load cell's declared point (load_point_error) or the
/// readings in `states` (misalignment, bias); a moved frame is undone by its finite motion.
///
/// Postures whose loaded readings the fit does not have (no reflector read in all load steps) cannot be corrected and
/// are left out, named in `left_out`. Throws InputError where the load cell's point does not move with the flange and
/// is to be corrected.
campaign::Campaign correctedFor(const EffectFit& effects, const campaign::Campaign& campaign,
                                std::vector<identification::LeftOutPosture>& left_out);

}  // namespace stiffscope::extended_model
