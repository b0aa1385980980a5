#pragma once

#include "core/identification/identification.h"

namespace stiffscope {

/// Identifies by all three methods from one load step. Never throws for what the data lacks: a method that
/// cannot be had says why. Throws InputError where the campaign has no load states at all.
///
/// The own weight needs stiffnesses to be taken off the sweeps, and the stiffnesses need the sweeps: the two
/// are found in turns, from the rigid arm on; three rounds settle to 1e-4 of a stiffness.
Identification identify(const Campaign& campaign, const IdentifyOptions& options = {});

/// The frames alone: with the own weight taken off where the campaign has what identifies the stiffnesses,
/// else without.
Frames settledFrames(const Campaign& campaign);

/// The result for a campaign without loads (core/identification/load_step.h, whatLoadsLack): its frames, step
/// 0, no load case, and for every method and joint what is missing.
Identification framesAlone(const Campaign& campaign);

}  // namespace stiffscope
