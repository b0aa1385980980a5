#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/rigid_points.h"
#include "metrology/axis_fit.h"
#include "metrology/tracker_noise.h"

namespace stiffscope {

/// One joint axis from its circle sweeps.
struct MeasuredAxis {
  bool measured = false;
  std::string reason;      ///< why not measured
  AxisFit fit;             ///< circles in the order of `targets`
  std::vector<int> targets;
  Vector6d swept_at = Vector6d::Zero();  ///< joint angles of the first reading, rad
  /// The axis where it was swept, in the frame of the readings, directed as the joint turns positively. Its
  /// covariance is that of the fit.
  MeasuredLine as_swept;
  /// The same with all joints at zero. Its covariance holds those of the axes it was turned back about too; what it
  /// has in common with those is in axesCovariance.
  MeasuredLine at_zero;
};

/// Circle-point (paper, II.D): fits the common axis of each joint's circles, on the readings referred to
/// the rigid arm, gives it the sense of the joint's turning, and turns it back to zero through the axes before it.
/// An axis without sweeps, or whose sweep moves other joints too, is not measured and says why.
std::array<MeasuredAxis, 6> measureAxes(const Campaign& campaign, const RigidPoints& points);

/// A line of the arm at joint angles q, where the joints before it, whose axes at zero are given, stand at zero.
Line turnedBack(const std::vector<Line>& axes_at_zero, const Vector6d& q, Line line);

/// The tracker's noise as the metrology package takes it.
TrackerNoise trackerNoise(const Tracker& tracker);

}  // namespace stiffscope
