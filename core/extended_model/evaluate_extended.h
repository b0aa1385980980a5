#pragma once

#include <vector>

#include "core/extended_model/extended_model.h"
#include "core/extended_model/method_equations.h"

namespace stiffscope::extended_model {

/// Judges the methods of `model.with` with the effects in the model: displacements are the machine's own, and on every
/// subset of postures (all up to a thousand, else a thousand drawn, and
/// fewer of a long day) effects and springs are fitted anew, the effects by
/// one linear step, the equations following them to first order. Fills shares, residuals, `subsets`, and the bootstrap
/// where it is asked for, of every available method, `model.spread.compliance`, and the displacements by case.
void evaluateExtended(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                      ExtendedModel& model);

}  // namespace stiffscope::extended_model
