#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

// Points and noise made in the tests, by formulas of their own.

namespace stiffscope {

inline double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Normal numbers that are the same on every machine: Box-Muller on the generator's bits, because the
/// standard library's normal_distribution may differ between libraries.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}

  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1.0p-53; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  Eigen::Vector3d direction() { return normal3().normalized(); }

  /// A draw with the given covariance, by its Cholesky factor.
  Eigen::Vector3d draw(const Eigen::Matrix3d& covariance) {
    return Eigen::Matrix3d(covariance.llt().matrixL()) * normal3();
  }

 private:
  std::mt19937_64 random_;
};

/// A laser tracker's covariance written out by hand: `along` the line of sight from the origin, `across` it.
inline Eigen::Matrix3d seenFromOrigin(const Eigen::Vector3d& point, double along, double across) {
  const Eigen::Vector3d beam = point.normalized();
  const Eigen::Matrix3d on_beam = beam * beam.transpose();
  return along * along * on_beam + across * across * (Eigen::Matrix3d::Identity() - on_beam);
}

/// A point at `angle` on a circle about `axis` (unit) through `centre`, `height` along it.
inline Eigen::Vector3d onCircle(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, double radius,
                                double height, double angle) {
  // Any perpendicular serves; this one is made without the library's.
  const Eigen::Vector3d helper = std::abs(axis.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d u = (helper - helper.dot(axis) * axis).normalized();
  return centre + height * axis + radius * (std::cos(angle) * u + std::sin(angle) * axis.cross(u));
}

}  // namespace stiffscope
