#pragma once

#include "core/identification/identify.h"
#include "core/improved/improved_model.h"

namespace stiffscope {

/// Judges a method of `model.with` with the effects in the model: displacements are the machine's own, and on every
/// subset of postures (all up to a thousand, else a thousand drawn) effects and springs are fitted anew, the effects by one
/// linear step, the equations moved along with them to first order. Fills shares, residuals, `subsets`, and the bootstrap
/// where it is asked for, of every available method.
void judgeImproved(const Campaign& measured, const IdentifyOptions& options, ImprovedModel& model);

}  // namespace stiffscope
