#pragma once

#include "core/blind/score.h"
#include "reports/page/html.h"

namespace stiffscope::page {

// The sections of the blind test's page, in its order.

void writeBlindRates(Html& html, const blind::Score& score);
void writeBlindSizes(Html& html, const blind::Score& score);
/// Rows that had no case are left out; cells are shaded by their share of the row.
void writeBlindConfusion(Html& html, const blind::Confusion& confusion);
void writeBlindEffects(Html& html, const blind::Score& score);
void writeBlindShrink(Html& html, const blind::Score& score);
void writeBlindMethod(Html& html);  ///< what sizes and rates mean

}  // namespace stiffscope::page
