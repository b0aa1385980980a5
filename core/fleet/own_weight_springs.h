#pragma once

#include "core/calibration/calibrate.h"
#include "core/fleet/campaign_result.h"

namespace stiffscope::fleet {

/// Compliances of the joints as a day without a load shows them by the torques of the arm's own weight, and their
/// influences, one a posture of the day (zero of one whose readings are all rejected). One model for every day, so that
/// days can be held against each other: geometry, base and reflectors, and the compliances of all joints, of either
/// sign, nothing chosen. What it misses (an eccentric gear, say) biases them by as much on every day that has the same
/// postures. Influences are g_p = N^-1 A_p^T (I - H_p)^-1/2 r_p of the whitened equations, as
/// identification::PostureGain has those of a loaded day. No variance is shared: base and reflectors are fitted, and
/// the geometry too, on every day anew.
///
/// A joint is identifiable where its compliance is at least kSeen standard uncertainties. Not available where the URDF
/// lacks masses, or there is no calibration.
SpringsOfDay ownWeightSprings(const calibration::Calibration& calibration);

/// A compliance below this many standard uncertainties says nothing of a share that it has changed by.
inline constexpr double kSeen = 3.0;

}  // namespace stiffscope::fleet
