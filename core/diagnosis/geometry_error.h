#pragma once

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// What a maker's arm is allowed: uncalibrated industrial arms place their flange absolutely to about a
/// millimetre.
inline constexpr double kGeometryTolerance = 0.5e-3;  ///< rms per coordinate, m

/// Base and reflectors of the nominal arm are placed as well as can be before the two are compared.
GeometryError geometryError(const GapInput& input, const GapState& state);

}  // namespace stiffscope
