#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// The geometry found against the nominal one (kinematic_error): where the URDF's axes would put the reflectors at the
/// postures of the loading (of the sweeps without any), base and reflectors placed as well as can be, against where the
/// axes that were found put them. No load, no own weight.
struct GeometryError {
  bool tested = false;
  std::string reason;           ///< why not
  double rms = 0.0;             ///< per coordinate, m
  double largest_shift = 0.0;   ///< of an axis, across it, m
  double largest_tilt = 0.0;    ///< of an axis, rad
};

/// What a maker's arm is allowed: uncalibrated industrial arms place their flange absolutely to about a millimetre.
inline constexpr double kGeometryTolerance = 0.5e-3;  ///< rms per coordinate, m

GeometryError geometryError(const GapInput& input, const GapState& state);

}  // namespace stiffscope
