#pragma once

#include <array>
#include <vector>

#include "core/audit/audit_input.h"
#include "metrology/axis_fit.h"

namespace stiffscope::audit {

/// The readings of one reflector while one axis turns, with their rows.
struct SweptCircle {
  int target = 0;
  metrology::CirclePoints readings;  ///< sag taken off where it can be
  std::vector<std::size_t> lines;
};

/// Circles of each axis in the order in which MeasuredAxis has them.
std::array<std::vector<SweptCircle>, 6> sweptCircles(const AuditInput& input);

/// Standard uncertainty of an axis, the larger of its two directions.
struct AxisUncertainty {
  double direction = 0.0;  ///< rad
  double place = 0.0;      ///< m, on the axis at the middle of its circles
};

AxisUncertainty uncertaintyOf(const metrology::AxisFit& fit);

/// How much larger the uncertainty of direction and place is with `readings` evenly over `arc` (rad) than
/// with as many over 90 deg. Both depend on the arc through the same 2x2 matrix: radial residuals move with
/// the place as axial ones do with the direction, by cos and sin of the place on the circle, with a radius or
/// height to be found too.
double arcCost(double arc, int readings);

}  // namespace stiffscope::audit
