#pragma once

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/fit.h"

namespace stiffscope::diagnosis {

/// What an arm is allowed that nobody calibrated. Nominal geometries of industrial arms miss by 0.1 to 0.3 mm
/// rms in a cell's volume once base and tool are fitted, and by up to a millimetre at its worst point; that
/// alone says nothing of a deflection.
inline constexpr double kGeometryTolerance = 0.4e-3;  ///< rms per coordinate, m

/// Base and reflectors of the nominal arm are placed as well as can be before the two are compared.
GeometryError geometryError(const SystemInput& input, const SystemState& state);

}  // namespace stiffscope::diagnosis
