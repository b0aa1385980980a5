#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// The tracker's noise as campaign.xml declares it; empty without a tracker, or where a figure is zero: a
/// variance of zero weights nothing.
std::optional<metrology::TrackerNoise> declaredNoise(const campaign::Campaign& campaign);

/// By how much the tracker's noise is multiplied along the beam and across it.
struct NoiseFactors {
  double along = 1.0, across = 1.0;
};

inline NoiseFactors operator*(const NoiseFactors& a, const NoiseFactors& b) {
  return {a.along * b.along, a.across * b.across};
}

/// The tracker with its noise along and across the beam multiplied. The repeats' check names a tracker that
/// is noisier than declared; the other checks then hold the readings against what the repeats show, so that
/// one cause gives one finding (GUM 4.2: an evaluation from repeats outweighs a data sheet).
campaign::Tracker asNoisyAs(campaign::Tracker tracker, const NoiseFactors& factors);

/// The last digit that all coordinates are written with, m; 0 where they are written more finely than any noise, or
/// than `finest`.
template <class Row>
double lastDigit(const std::vector<Row>& rows, double finest = 0.0) {
  // Two of them are 0.01 and 0.001 inch, which are whole again in four digits of a millimetre.
  for (const double digit : {1e-3, 2.54e-4, 1e-4, 2.54e-5, 1e-5, 1e-6, 1e-7}) {
    if (digit < finest) break;
    constexpr double kExact = 1e-4;  // of a digit: 100 m in double precision keep it
    const bool whole = std::all_of(rows.begin(), rows.end(), [&](const Row& row) {
      const Eigen::Array3d digits = row.point.array() / digit;
      return ((digits - digits.round()).abs() < kExact).all();
    });
    if (whole) return digit;
  }
  return 0.0;
}

/// What few digits add to the declared noise of a table's readings: each coordinate is off by up to half of the last
/// one, evenly, a variance of digit^2 / 12 in every direction (GUM F.2.2.1). As factors of the declared noise on
/// average over the readings.
struct Rounded {
  double digit = 0.0;  ///< m; 0 where it adds nothing
  NoiseFactors factors;
};

/// Of sweeps and loading together the table with the fewest digits, and of the nests: rounds of these may be written
/// down otherwise. Has to be asked of readings as they were read, which nothing has moved.
struct Rounding {
  Rounded arm, nests;
};

Rounding roundingOf(const campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
