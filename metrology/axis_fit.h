#pragma once

#include <Eigen/Core>
#include <vector>

#include "metrology/lines.h"
#include "metrology/measured_points.h"
#include "metrology/remark.h"

namespace stiffscope::metrology {

/// The readings of one reflector while one axis turns (m, m^2).
using CirclePoints = MeasuredPoints;

/// Circle of one reflector about the common axis.
struct AxisCircle {
  double radius = 0.0;  ///< m
  double height = 0.0;  ///< place of its plane along the axis, from MeasuredLine::line.point, m
  double arc = 0.0;     ///< rad between the ends of the swept arc, 0..2 pi
  double rms = 0.0;     ///< of the radial and axial residuals, per coordinate, m
};

/// Result of the circle-point method for one axis (paper, II.D).
struct AxisFit {
  bool determined = false;
  Remark reason;      ///< why not determined
  MeasuredLine axis;  ///< direction sense as the fit found it: the caller gives it a sign
  std::vector<AxisCircle> circles;
  double rms = 0.0;           ///< plain, over radial and axial residuals of all points, m
  double chi2_per_dof = 0.0;  ///< with covariances given: weighted; 1 without
  int degrees_of_freedom = 0;
};

/// Circle-point: the circles that several reflectors describe about one axis share that axis. Least squares
/// on the residuals of every point, radial (rho - r_k) and along the axis (h - h_k), over the line's four
/// degrees of freedom and each circle's radius and height; weighted by the covariance of (radial, axial)
/// where covariances are given. Covariance of the result: inverse normal matrix, times chi2/dof where that
/// exceeds 1 (or times the residual variance where no covariances are given). Start: pooled plane normal and
/// Taubin's common centre. Undetermined with a reason: fewer than 3 points in every circle, none in one of
/// them, points that all lie on one line or in one place.
AxisFit fitAxis(const std::vector<CirclePoints>& circles);

/// The arc that points cover about an axis: 2 pi less the largest gap between neighbouring points (rad), so that
/// a full turn of n even stops gives 2 pi (n-1)/n. 0 for fewer than two points.
double sweptArc(const Line& axis, const std::vector<Eigen::Vector3d>& points);

}  // namespace stiffscope::metrology
