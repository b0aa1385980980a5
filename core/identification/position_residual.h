#pragma once

#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "core/robot/robot.h"

namespace stiffscope {

/// Estimated numbers, as steps from the start: per axis shift_u, shift_v (m), tilt_u, tilt_v (rad); the
/// base's small motion, rotation vector then translation, in the readings' frame; the reflectors' places at
/// zero (m).
struct CalibrationParameters {
  std::array<double, 24> axes{};
  std::array<double, 6> base{};
  std::vector<std::array<double, 3>> targets;
};

struct CalibrationStart {
  std::array<Line, 6> axes;
  std::array<Eigen::Vector3d, 6> across_u, across_v;
  Eigen::Isometry3d points_from_base;
};

/// Residual: measured minus modelled place of one reflector, in the readings' frame, whitened.
struct PositionResidual {
  const CalibrationStart& start;
  Vector6d q;  // with the sag in
  Eigen::Vector3d measured;
  Eigen::Matrix3d whiten;

  /// A point turned about a joint's axis by its angle, the axis moved by its four numbers `own`.
  template <class T>
  Eigen::Matrix<T, 3, 1> turned(int joint, const T* own, const Eigen::Matrix<T, 3, 1>& x) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const auto j = static_cast<std::size_t>(joint);
    const Vector point = start.axes[j].point.cast<T>() + start.across_u[j].cast<T>() * own[0] +
                         start.across_v[j].cast<T>() * own[1];
    const Vector direction = (start.axes[j].direction.cast<T>() + start.across_u[j].cast<T>() * own[2] +
                              start.across_v[j].cast<T>() * own[3])
                                 .normalized();
    const Vector from = x - point;
    const double cosine = std::cos(q[joint]), sine = std::sin(q[joint]);
    return point + from * T(cosine) + direction.cross(from) * T(sine) +
           direction * (direction.dot(from) * T(1.0 - cosine));
  }

  /// A point of the arm's base in the readings' frame, that moved by `base`.
  template <class T>
  Eigen::Matrix<T, 3, 1> placed(const T* base, const Eigen::Matrix<T, 3, 1>& x) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Vector at_start =
        start.points_from_base.linear().cast<T>() * x + start.points_from_base.translation().cast<T>();
    Vector moved;
    ceres::AngleAxisRotatePoint(base, at_start.data(), moved.data());
    return moved + Vector(base[3], base[4], base[5]);
  }

  template <class T>
  bool operator()(const T* axes, const T* base, const T* target, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    Vector x(target[0], target[1], target[2]);
    // Innermost turn first: exp(xi_1 q_1) ... exp(xi_6 q_6) x.
    for (int joint = 5; joint >= 0; --joint) x = turned(joint, axes + 4 * joint, x);
    Eigen::Map<Vector>(residual, 3) = whiten.cast<T>() * (measured.cast<T>() - placed(base, x));
    return true;
  }
};

}  // namespace stiffscope
