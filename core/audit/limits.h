#pragma once

#include "core/io/units.h"
#include "core/preparation/finding.h"

// Every limit of the audit, with where it comes from. None is fitted to a campaign: they come from the
// statistics of the declared noise, or from practice that is stated here.

namespace stiffscope::audit {

/// Arc of a circle sweep. The centre's uncertainty along the bisector grows with the inverse square of the
/// arc: at 90 deg it is 7.3 times that of the whole circle for 20 readings, at 45 deg 3.9 times that again
/// (largest eigenvalue of the inverse of the normal matrix of cos, sin, 1). What an arc costs is judged at
/// the arm's reach; these say from where on a reader should know it, and from where on it fails if it costs
/// too much.
inline constexpr double kWarnArc = 90.0 * io::kDegree;
inline constexpr double kFailArc = 45.0 * io::kDegree;

/// What one contribution may use of a tolerance: a third, which raises a root sum of squares by 5 % (Berndt's
/// golden rule of metrology: a tenth to a third). The tolerance here is how far identification trusts places
/// (TrustLimits::position, 0.2 mm).
inline constexpr double kShareOfTolerance = 1.0 / 3.0;

/// A cause is named for a misfit only where it explains more of it than everything else together (in
/// variance).
inline constexpr double kExplains = 0.5;

/// Readings of one circle: three make it (six numbers, two of each reading), twice as many give every reading
/// a redundancy number of a half: a wrong one shows half of its error in its own residual (Baarda).
inline constexpr int kLeastCircleReadings = 6;

/// A 1.5 inch spherically mounted reflector has a radius of 19.05 mm: nearer than that, the axis passes
/// through the reflector itself. Its circle then says next to nothing about the axis: 20 readings of 10 um
/// over the whole circle know the direction to 10 um sqrt(2/20)/19 mm, 0.37 mm at a reach of 2.2 m, twice the
/// tolerance.
inline constexpr double kReflectorRadius = 19.05e-3;

/// Condition number of the identification, columns scaled to unit length: calibration practice (Schroeer)
/// asks for less than 100.
inline constexpr double kCondition = 100.0;

/// How far a declared noise may be from what the readings show, as a ratio of standard deviations, either way: an
/// interval stated with k = 2 for 95 % (GUM 6.2) then covers 68 %, or is twice as wide as it need be. Data sheets give
/// maximum permissible errors, which are two to three sigma (ISO 10360-10); one sigma is asked for.
inline constexpr double kWrongNoise = 2.0;

/// Longest lever of a load about the load cell, m: the longest arms of any maker reach less than 5 m, and a tool is
/// shorter than its arm. Forces or moments in another unit give one of a hundred metres.
inline constexpr double kLongestLever = 5.0;

/// Poses that a controller states are computed from the joints beside them, m: a thousandth of a degree of each joint
/// at 3 m makes 0.05 mm, poses have as many digits. Identification trusts places to TrustLimits::position, 0.2 mm.
inline constexpr double kControllerDigits = 0.2e-3;

/// Rails of robots are laid and racks are cut to a tenth of a millimetre a metre and better; what they are off is
/// measured and taken off. Travel reported in another unit is off by a tenth at least.
inline constexpr double kRailScale = 1e-3;
inline constexpr double kOtherUnit = 0.05;

/// What a carriage leaves of a straight line, m: worn rails wave by some tenths of a millimetre, and a turn of the
/// carriage moves the reflectors by as much. More is no rail.
inline constexpr double kNoRail = 2e-3;

/// Rails are laid along an axis of the robot's foot to a fraction of a degree; beyond kOtherRail it is another axis, or
/// the other way.
inline constexpr double kRailDirection = 1.0 * io::kDegree;
inline constexpr double kOtherRail = 10.0 * io::kDegree;

}  // namespace stiffscope::audit
