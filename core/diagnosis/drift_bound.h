#pragma once

#include "core/diagnosis/gap_data.h"
#include "core/diagnosis/gap_start.h"

namespace stiffscope {

/// Nests that show no motion by themselves still bound a drift: their rate, with its weight, takes part in the
/// fit as a reading of trackerDrift's parameters (readings move against what brings them back). Nothing where
/// there is no rate, or no absolute positions that a drift would move; nothing where the nests do show a
/// motion, which is taken off instead. Puts the sweeps' epoch between the first round and the loading.
void boundDriftByNests(GapStart& start, GapInput& input);

}  // namespace stiffscope
