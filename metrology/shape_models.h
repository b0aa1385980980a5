#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>

#include "metrology/least_squares.h"
#include "metrology/lines.h"

namespace stiffscope::metrology {

/// The common centre of concentric circles (Dim 2) or spheres (Dim 3), one a group, from the points projected
/// on the columns of `basis`: the algebraic fit of G. Taubin, IEEE Trans. PAMI 13 (1991) 1115, which on short
/// arcs does not shrink the radius as Kasa's does. Least sum of (A |x|^2 + b.x + D_k)^2 over the sum of its
/// squared gradient; taking each group's means off removes its D_k, and the rest is the least eigenvector of
/// a symmetric matrix of Dim + 1. Groups of fewer than three points take no part. In local units, relative to
/// the local origin; empty where the points are as well on a line (a plane).
template <int Dim>
std::optional<Eigen::Matrix<double, Dim, 1>> algebraicCentre(const LocalPoints& local,
                                                             const Eigen::Matrix<double, 3, Dim>& basis);

extern template std::optional<Eigen::Vector2d> algebraicCentre<2>(const LocalPoints&,
                                                                  const Eigen::Matrix<double, 3, 2>&);
extern template std::optional<Eigen::Vector3d> algebraicCentre<3>(const LocalPoints&,
                                                                  const Eigen::Matrix<double, 3, 3>&);

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

/// The start of a fit of circles about one axis: across the axis the plane in which the points spread most
/// about their groups' means, in it Taubin's common centre. Groups of fewer than three points take no part.
/// Empty, with the reason, where the points lie on one line.
std::optional<CirclesModel> circlesStart(const LocalPoints& local, std::string& reason);

/// Mean radius and height of each group about the axis.
Eigen::Matrix2Xd firstOwn(const CirclesModel& model, const LocalPoints& local);

/// A straight line: the two components of a point's distance, along u and v. Shared parameters as those
/// of the circles above.
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

/// Parallel planes, one a group: residual n.p - height. Shared parameters: tilts of the normal towards u and
/// v.
struct PlanesModel {
  static constexpr int kShared = 2, kOwn = 1, kResiduals = 1;
  AxisFrame normal;  ///< through the local origin

  Observation<PlanesModel> observe(std::size_t, const Eigen::Vector3d& point,
                                   const Eigen::Matrix<double, 1, 1>& height) const {
    Observation<PlanesModel> seen;
    seen.residual << static_cast<double>(normal.heightOf(point) - height[0]);
    seen.rows << normal.u().dot(point), normal.v().dot(point), -1.0;
    seen.directions = normal.direction();
    return seen;
  }
  void move(const Eigen::Vector2d& step) { normal.move({0.0, 0.0, step[0], step[1]}); }
};

/// Concentric spheres, one a group: residual |p - centre| - r. Shared parameters: the centre. Own: the
/// radius.
struct SpheresModel {
  static constexpr int kShared = 3, kOwn = 1, kResiduals = 1;
  Eigen::Vector3d centre;

  Observation<SpheresModel> observe(std::size_t, const Eigen::Vector3d& point,
                                    const Eigen::Matrix<double, 1, 1>& radius) const {
    long double square = 0.0L;
    for (int k = 0; k < 3; ++k) {
      const long double from = static_cast<long double>(point[k]) - centre[k];
      square += from * from;
    }
    const long double distance = std::sqrt(square);
    Observation<SpheresModel> seen;
    seen.residual << static_cast<double>(distance - radius[0]);
    const Eigen::Vector3d outward = distance > 0.0L
                                        ? Eigen::Vector3d((point - centre) / static_cast<double>(distance))
                                        : Eigen::Vector3d::UnitX();  // at the centre any serves
    seen.rows << -outward.transpose(), -1.0;
    seen.directions = outward;
    return seen;
  }
  void move(const Eigen::Vector3d& step) { centre += step; }
};

}  // namespace stiffscope::metrology
