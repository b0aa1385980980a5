#pragma once

#include "metrology/axis_frame.h"
#include "metrology/finish_fit.h"

namespace stiffscope {

/// A straight line: the two components of a point's distance, along u and v. Shared parameters as in
/// axis_models.h.
struct LineModel {
  static constexpr int kShared = 4, kOwn = 0, kResiduals = 2;
  AxisFrame axis;

  Observation<LineModel> observe(std::size_t, const Eigen::Vector3d& point,
                                 const Eigen::Matrix<double, 0, 1>&) const {
    long double h = 0.0L, u = 0.0L, v = 0.0L;
    for (int k = 0; k < 3; ++k) {
      const long double from = static_cast<long double>(point[k]) - axis.point()[k];
      h += from * axis.direction()[k];
      u += from * axis.u()[k];
      v += from * axis.v()[k];
    }
    Observation<LineModel> seen;
    seen.residual << static_cast<double>(u), static_cast<double>(v);
    const double height = static_cast<double>(h);
    seen.rows << -1.0, 0.0, -height, 0.0,  //
        0.0, -1.0, 0.0, -height;
    seen.directions << axis.u(), axis.v();
    return seen;
  }
  void move(const Eigen::Vector4d& step) { axis.move(step); }
};

}  // namespace stiffscope
