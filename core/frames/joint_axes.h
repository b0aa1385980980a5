#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/gravity_sag.h"
#include "metrology/axis_fit.h"
#include "metrology/measured_points.h"
#include "metrology/remark.h"

namespace stiffscope::frames {

/// rad: a joint that moves less stands still; the resolution of a controller's read-back.
inline constexpr double kStandsStill = 1e-5;

/// One joint axis from its circle sweeps.
struct MeasuredAxis {
  bool measured = false;
  Remark reason;           ///< why not measured; of coupled joints why there are no circles
  metrology::AxisFit fit;  ///< circles in the order of `targets`
  std::vector<int> targets;
  JointVector swept_at;  ///< joint angles of the first reading, rad; zero where not measured
  /// The axis where it was swept, in the frame of the readings, directed as the joint turns positively. Its
  /// covariance is that of the fit.
  metrology::MeasuredLine as_swept;
  /// The same with all joints at zero. Its covariance holds those of the axes it was turned back about too; what it
  /// has in common with those is in axesCovariance.
  metrology::MeasuredLine at_zero;

  /// Not measured, of a machine of so many joints.
  explicit MeasuredAxis(int joints) : swept_at(JointVector::Zero(joints)) {}
};
using MeasuredAxes = PerJoint<MeasuredAxis>;

/// Circle-point (paper, II.D): fits the common axis of each joint's circles, on the readings referred to
/// the rigid arm, gives it the sense of the joint's turning, and turns it back to zero through the axes before it.
/// An axis without sweeps, or whose sweep moves other joints too, is not measured and says why; of an arm with coupled
/// joints all are found together (fitCoupledAxes), without circles of their own.
/// Of a day of several stations the uncertainty of a station's pose is in that of the axes that were read from it; that
/// axes of one station share it is left out, which makes what is said between them no smaller than it is.
MeasuredAxes measureAxes(const campaign::Campaign& campaign, const RigidPoints& points);

/// A line of the arm at joint angles q, where the joints before it, whose axes at zero are given, stand at zero.
metrology::Line turnedBack(const std::vector<metrology::Line>& axes_at_zero, const JointVector& q,
                           metrology::Line line);

/// The tracker's noise as the metrology package takes it.
metrology::TrackerNoise trackerNoise(const campaign::Tracker& tracker);

/// Covariance of the axes' parameters at zero, four an axis in the order of MeasuredLine, at MeasuredAxis::at_zero.
/// m, rad.
using AxesCovariance =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 4 * kMostJoints, 4 * kMostJoints>;

/// Law of propagation (GUM 5.2.2) from the fits, which are independent of each other, to the axes at zero, which are
/// not: an axis swept with the joints before it away from zero is turned back about measured axes, and takes part
/// in their errors. Joint angles count as exact. Rows of axes that are not measured are zero.
AxesCovariance axesCovariance(const MeasuredAxes& axes);

}  // namespace stiffscope::frames
