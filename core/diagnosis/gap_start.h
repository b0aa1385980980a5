#pragma once

#include <string>

#include "core/diagnosis/gap_fit.h"
#include "core/diagnosis/station.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

/// Noise of one reading as the diagnosis takes it.
struct NoiseFloor {
  bool known = false;
  TrackerNoise noise;
  double along_factor = 1.0, across_factor = 1.0;  ///< standard deviations found against declared
  double degrees = 0.0;                            ///< of freedom of what it was found from; 0: as declared
  std::string source;
};

/// By the scatter of repeats where there are enough of them (30 degrees of freedom along and across the
/// beam), in the shape of the declared noise; else as declared. Not known without a declared tracker.
NoiseFloor noiseFloor(const Campaign& campaign);

/// A campaign made ready: screened, the station's motion taken off, frames and stiffnesses found, the arm's
/// geometry from the sweeps or, without them, calibrated on the unloaded positions.
struct GapStart {
  Campaign campaign;
  Station station;
  NoiseFloor noise;
  LoadingGeometry geometry;
  bool absolute = false, sweeps = false;
  GapState state;
  double geometric_stiffness_share = 0.0;
  std::string reason;  ///< why there is no gap to look at; empty where there is
};

GapStart gapStart(const Campaign& campaign, bool take_off_station);

}  // namespace stiffscope
