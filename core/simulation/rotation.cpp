#include "core/simulation/rotation.h"

#include <cmath>

namespace stiffscope::simulation {

namespace {

/// sin a / a, (1 - cos a) / a^2, (a - sin a) / a^3. Below 0.1 rad by their series, whose first term left out
/// is below 1e-17.
struct RotationSeries {
  double sine, versine, third;

  explicit RotationSeries(double a) {
    const double s = a * a;
    if (a < 0.1) {
      sine = 1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
      versine = 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132)))));
      third = 1.0 / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
    } else {
      sine = std::sin(a) / a;
      versine = 2.0 * std::pow(std::sin(0.5 * a) / a, 2);
      third = (a - std::sin(a)) / (s * a);
    }
  }
};

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d rotationExp(const Eigen::Vector3d& v) {
  const RotationSeries series(v.norm());
  const Eigen::Matrix3d cross = skew(v);
  return Eigen::Matrix3d::Identity() + series.sine * cross + series.versine * cross * cross;
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v) {
  const RotationSeries series(v.norm());
  const Eigen::Matrix3d cross = skew(v);
  return Eigen::Matrix3d::Identity() + series.versine * cross + series.third * cross * cross;
}

Eigen::Isometry3d turnAbout(const metrology::Line& axis, double angle) {
  return turnAbout(axis.point, axis.direction * angle);
}

Eigen::Isometry3d turnAbout(const Eigen::Vector3d& point, const Eigen::Vector3d& rotation_vector) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationExp(rotation_vector);
  motion.translation() = point - motion.linear() * point;
  return motion;
}

Eigen::Isometry3d frameAlong(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = direction.normalized();
  // The base axis least along z gives x: robot axes then get x and y along base axes themselves.
  Eigen::Index least = 0;
  z.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d x = (Eigen::Vector3d::Unit(least) - z * z[least]).normalized();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() << x, z.cross(x), z;
  frame.translation() = origin;
  return frame;
}

}  // namespace stiffscope::simulation
