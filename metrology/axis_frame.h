#pragma once

#include <Eigen/Core>
#include <cmath>

#include "metrology/measured_line.h"

namespace stiffscope {

/// Where a point lies about an axis. Radius and height in extended precision: residuals are made of them.
struct PlaceAboutAxis {
  long double radius = 0.0L, height = 0.0L;
  double outward_u = 1.0,
         outward_v = 0.0;  ///< components of the unit vector outward; towards u on the axis itself
};

/// A line that a fit moves, with a basis (across_u, across_v, direction). On machines whose long double is no
/// longer than double the fits lose about the digits that short arcs cost; nothing else changes.
class AxisFrame {
 public:
  AxisFrame(const Eigen::Vector3d& point, const Eigen::Vector3d& direction);

  const Eigen::Vector3d& point() const { return axis_.line.point; }
  const Eigen::Vector3d& direction() const { return axis_.line.direction; }
  const Eigen::Vector3d& u() const { return axis_.across_u; }
  const Eigen::Vector3d& v() const { return axis_.across_v; }
  const MeasuredLine& measured() const { return axis_; }

  /// Along the direction, from point().
  long double heightOf(const Eigen::Vector3d& at) const {
    long double height = 0.0L;
    for (int k = 0; k < 3; ++k) height += exact_[k] * (static_cast<long double>(at[k]) - axis_.line.point[k]);
    return height;
  }

  PlaceAboutAxis placeOf(const Eigen::Vector3d& at) const {
    const long double x = static_cast<long double>(at.x()) - axis_.line.point.x();
    const long double y = static_cast<long double>(at.y()) - axis_.line.point.y();
    const long double z = static_cast<long double>(at.z()) - axis_.line.point.z();
    PlaceAboutAxis place;
    place.height = exact_[0] * x + exact_[1] * y + exact_[2] * z;
    const long double rx = x - place.height * exact_[0], ry = y - place.height * exact_[1],
                      rz = z - place.height * exact_[2];
    place.radius = std::sqrt(rx * rx + ry * ry + rz * rz);
    if (place.radius > 0.0L) {
      const Eigen::Vector3d radial(static_cast<double>(rx), static_cast<double>(ry), static_cast<double>(rz));
      const double inverse = 1.0 / static_cast<double>(place.radius);
      place.outward_u = inverse * radial.dot(axis_.across_u);
      place.outward_v = inverse * radial.dot(axis_.across_v);
    }
    return place;
  }

  /// By the four parameters of a line: (shift_u, shift_v, tilt_u, tilt_v).
  void move(const Eigen::Vector4d& step);

 private:
  void setBasis();
  MeasuredLine axis_;
  long double exact_[3];  ///< the direction with its length divided out beyond double precision
};

/// The unit vector with its largest component positive: lines and planes have no sense of their own.
Eigen::Vector3d largestPositive(const Eigen::Vector3d& direction);

}  // namespace stiffscope
