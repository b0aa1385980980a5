#pragma once

#include "core/extended_model/hidden_effects.h"
#include "core/identification/identify.h"

namespace stiffscope::extended_model {

/// What `campaign` declares with a standard uncertainty, at the result `at` that was identified from it by `options`.
/// Masses (the URDF's, all by one factor; the tool is weighed by itself) and the tracker's scale (distances from its
/// station) act by a difference of the whole identification, one declared standard uncertainty up. Nothing is
/// identified anew for what is not declared.
Declared declaredOf(const campaign::Campaign& campaign, const identification::Identification& at,
                    const identification::IdentifyOptions& options);

}  // namespace stiffscope::extended_model
