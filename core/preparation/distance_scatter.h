#pragma once

#include "core/campaign/campaign.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// The noise of a reading by the distances between reflectors, which the arm carries about unchanged: for a day whose
/// states were read once, so that no repeats tell it. Along the beam and across it together.
struct DistanceScatter {
  double ratio = 1.0;    ///< variance of a reading, found over declared
  double degrees = 0.0;  ///< of freedom of that; 0: there are no distances to compare
  /// Whether chance alone takes the ratio so far from 1 (two of its standard deviations).
  bool asDeclared() const;
};

/// Of each two reflectors that were read in one state from one station, the change of their distance from one posture
/// to the next under the same load step, over its variance by the declared noise. The median of the squares stands for
/// all: a reflector that slips once, or is knocked, makes one change. What the load does to a plate under the
/// reflectors stays out, since the steps are the same; a plate that gives differently from posture to posture counts as
/// noise.
///
/// Degrees of freedom: a median is worth 0.37 of its sample, changes that share a posture 2/3 (von Neumann), and of the
/// distances among n reflectors 3 n - 6 are independent.
DistanceScatter distanceScatter(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise);

}  // namespace stiffscope::preparation
