#pragma once

#include "metrology/axis_frame.h"
#include "metrology/least_squares.h"

namespace stiffscope {

// Shapes about an axis as models of least_squares.h. Shared parameters: (shift_u, shift_v, tilt_u, tilt_v) of
// the axis where it stands. e_u, e_v: the outward unit vector; rho, h: radius and height of a point.

/// Circles about one axis: radial residual rho - r and axial residual h - h_k. Own parameters: radius r,
/// height h_k.
struct CirclesModel {
  static constexpr int kShared = 4, kOwn = 2, kResiduals = 2;
  AxisFrame axis;

  Observation<CirclesModel> observe(std::size_t, const Eigen::Vector3d& point,
                                    const Eigen::Vector2d& own) const {
    const PlaceAboutAxis place = axis.placeOf(point);
    const double rho = static_cast<double>(place.radius), h = static_cast<double>(place.height);
    const double eu = place.outward_u, ev = place.outward_v;
    Observation<CirclesModel> seen;
    seen.residual << static_cast<double>(place.radius - own[0]), static_cast<double>(place.height - own[1]);
    seen.rows << -eu, -ev, -h * eu, -h * ev, -1.0, 0.0,  //
        0.0, 0.0, rho * eu, rho * ev, 0.0, -1.0;
    seen.directions << eu * axis.u() + ev * axis.v(), axis.direction();
    return seen;
  }
  void move(const Eigen::Vector4d& step) { axis.move(step); }
};

/// Cylinders about one axis: radial residual rho - r. Own parameter: radius r.
struct CylindersModel {
  static constexpr int kShared = 4, kOwn = 1, kResiduals = 1;
  AxisFrame axis;

  Observation<CylindersModel> observe(std::size_t, const Eigen::Vector3d& point,
                                      const Eigen::Matrix<double, 1, 1>& own) const {
    const PlaceAboutAxis place = axis.placeOf(point);
    const double h = static_cast<double>(place.height), eu = place.outward_u, ev = place.outward_v;
    Observation<CylindersModel> seen;
    seen.residual << static_cast<double>(place.radius - own[0]);
    seen.rows << -eu, -ev, -h * eu, -h * ev, -1.0;
    seen.directions << eu * axis.u() + ev * axis.v();
    return seen;
  }
  void move(const Eigen::Vector4d& step) { axis.move(step); }
};

}  // namespace stiffscope
