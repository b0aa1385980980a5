#pragma once

#include <string>

// Every limit of the audit, with where it comes from. None is fitted to a campaign: they come from the
// statistics of the declared noise, or from practice that is stated here.

namespace stiffscope::audit_limits {

/// Chance that a campaign without any fault gets a finding, over all checks together.
inline constexpr double kFalseFinding = 0.01;

/// Checks that share it; each divides its part again by the readings, postures or reflectors it tries
/// (Bonferroni).
inline constexpr double kChecks = 20.0;
inline constexpr double kLevel = kFalseFinding / kChecks;

/// A finding is a failure where what was found is more than twice what noise alone puts there: any
/// uncertainty that is stated from the declared noise is then wrong by a factor of two. As a ratio of
/// variances:
inline constexpr double kFailVarianceRatio = 4.0;

/// Arc of a circle sweep. Below 90 deg the centre's uncertainty along the bisector grows with the inverse
/// square of the arc; below 45 deg it is some four times that at 90 deg: common practice of the circle-point
/// method.
inline constexpr double kWarnArcDeg = 90.0;
inline constexpr double kFailArcDeg = 45.0;

/// What one contribution may use of a tolerance: a third, the usual rule for the ratio of measurement
/// uncertainty to what it is held against. The tolerance here is how far identification trusts places
/// (TrustLimits::position, 0.2 mm).
inline constexpr double kShareOfTolerance = 1.0 / 3.0;

/// A cause is named for a misfit only where it explains the larger part of it (in variance).
inline constexpr double kExplains = 0.5;

/// Readings of one circle: three make it, twice as many leave as many again to check it by.
inline constexpr int kLeastCircleReadings = 6;

/// A 1.5 inch spherically mounted reflector has a radius of 19.05 mm: nearer than that, the axis passes
/// through the reflector itself, and its circle says next to nothing about the axis.
inline constexpr double kReflectorRadius = 19.05e-3;

/// Condition number of the identification, columns scaled to unit length: calibration practice (Schroeer)
/// asks for less than 100.
inline constexpr double kCondition = 100.0;

/// A later step with a force below this share of its posture's largest is a return to zero (campaign format).
inline constexpr double kReturnShare = 0.05;

/// Stiffnesses by which the own weight's sag is computed are trusted to this share where they come from loads
/// that the joints' model does not explain fully (bearings, links): masses of a URDF are not known better
/// either.
inline constexpr double kSagShare = 0.1;

/// For limit_source.
inline std::string byChance(const std::string& statistic) {
  return statistic + "; 1 % false findings over the whole audit, shared by all that is tried";
}

}  // namespace stiffscope::audit_limits
