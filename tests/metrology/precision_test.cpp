#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdio>
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/sphere_fit.h"
#include "reports/words/remark_words.h"
#include "tests/metrology/simulated_points.h"

// Where no certificate is at hand: short arcs and data far from the origin, against the same least squares
// computed apart in long double throughout (64 bits against 53), by QR instead of normal equations and from
// the truth as the start. Asked for are a few roundings of the coordinates, which the result itself has, and
// 1e-14 of the radius.

namespace stiffscope {
namespace precision_test {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// A shape about an axis by (point, direction, radius): of a sphere the point alone counts.
struct Reference {
  Vector point, direction;
  Real radius;
};

enum class Kind { circle, sphere, cylinder };

Reference leastSquares(Kind kind, const std::vector<Eigen::Vector3d>& points, Reference at) {
  const auto count = static_cast<Eigen::Index>(points.size());
  // The points' own mean as origin, exactly as precise as the numbers themselves.
  Vector mean = Vector::Zero();
  for (const auto& point : points) mean += point.cast<Real>() / static_cast<Real>(count);
  at.point -= mean;
  for (int step = 0; step < 60; ++step) {
    at.direction /= std::sqrt(at.direction.squaredNorm());
    Vector u = at.direction.unitOrthogonal();
    u = (u - at.direction.dot(u) * at.direction).eval();
    u /= std::sqrt(u.squaredNorm());
    const Vector v = at.direction.cross(u);
    const int each = kind == Kind::circle ? 2 : 1;
    Rows rows = Rows::Zero(each * count, kind == Kind::circle ? 6 : kind == Kind::sphere ? 4 : 5);
    Column residuals(each * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Vector from = points[static_cast<std::size_t>(i)].cast<Real>() - mean - at.point;
      const Real h = at.direction.dot(from);
      const Vector across = kind == Kind::sphere ? from : Vector(from - h * at.direction);
      const Real rho = std::sqrt(across.squaredNorm());
      const Vector e = across / rho;
      residuals[each * i] = rho - at.radius;
      if (kind == Kind::sphere) {
        rows.row(i) << -e.transpose(), -1;
      } else if (kind == Kind::cylinder) {
        rows.row(i) << -e.dot(u), -e.dot(v), -h * e.dot(u), -h * e.dot(v), -1;
      } else {
        rows.row(2 * i) << -e.dot(u), -e.dot(v), -h * e.dot(u), -h * e.dot(v), -1, 0;
        rows.row(2 * i + 1) << 0, 0, rho * e.dot(u), rho * e.dot(v), 0, -1;
        residuals[2 * i + 1] = h;
      }
    }
    const Column change = rows.colPivHouseholderQr().solve(-residuals);
    if (kind == Kind::sphere) {
      at.point += change.head<3>();
      at.radius += change[3];
    } else {
      at.point += change[0] * u + change[1] * v;
      if (kind == Kind::circle) at.point += change[5] * at.direction;
      at.direction += change[2] * u + change[3] * v;
      at.radius += change[4];
    }
  }
  at.point += mean;
  return at;
}

struct Scene {
  double degrees, offset, size;  ///< arc, distance from the origin, radius
};

Eigen::Vector3d centreOf(const Scene& scene) { return scene.offset * Eigen::Vector3d(0.6, -0.48, 0.64); }
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();

std::vector<Eigen::Vector3d> points(const Scene& scene, double height, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Eigen::Vector3d> all;
  for (int i = 0; i < 40; ++i) {
    const double angle = radians(scene.degrees) * noise.uniform(),
                 along = height * scene.size * (noise.uniform() - 0.5);
    all.push_back(onCircle(centreOf(scene), kAxis, scene.size, along, angle) + 1e-5 * scene.size * noise.normal3());
  }
  return all;
}

std::vector<Eigen::Vector3d> cap(const Scene& scene, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Eigen::Vector3d> all;
  const double lowest = std::cos(radians(0.5 * scene.degrees));
  for (int i = 0; i < 60; ++i) {
    const double z = lowest + (1.0 - lowest) * noise.uniform(), angle = 7.0 * noise.uniform(),
                 across = std::sqrt(1.0 - z * z);
    all.push_back(
        centreOf(scene) +
        scene.size * (Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), z) + 1e-5 * noise.normal3()));
  }
  return all;
}

const std::vector<Scene> kScenes{{5, 0, 1},    {5, 100, 1},    {10, 100, 1},  {20, 100, 2},
                                 {40, 100, 1}, {40, 1e6, 500}, {5, 1e6, 500}, {360, 100, 1}};

/// A few roundings of the coordinates and of the radius.
double allowed(const Scene& scene) { return 4.0 * 2.3e-16 * scene.offset + 1e-14 * scene.size; }

TEST(Precision, CirclesOnShortArcsFarAway) {
  double worst = 0.0, worst_direction = 0.0;
  for (const Scene& scene : kScenes) {
    const auto data = points(scene, 0.0, 3);
    const metrology::FittedCircle fit = metrology::fitCircle({data, {}});
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    const Reference exact = leastSquares(
        Kind::circle, data, {centreOf(scene).cast<Real>(), kAxis.cast<Real>(), static_cast<Real>(scene.size)});
    const auto centre = static_cast<double>((fit.circle.centre.cast<Real>() - exact.point).norm());
    const auto direction = static_cast<double>(fit.circle.normal.cast<Real>().cross(exact.direction).norm());
    EXPECT_LT(centre, allowed(scene)) << scene.degrees << " " << scene.offset;
    EXPECT_LT(std::abs(static_cast<double>(fit.circle.radius - exact.radius)), allowed(scene)) << scene.degrees;
    EXPECT_LT(direction, 1e-14) << scene.degrees << " " << scene.offset;
    worst = std::max(worst, centre / allowed(scene));
    worst_direction = std::max(worst_direction, direction);
  }
  std::printf("circles against long double: centre %.2f of what is allowed, normal %.1e\n", worst, worst_direction);
}

TEST(Precision, SpheresOnSmallCapsFarAway) {
  double worst = 0.0;
  for (const Scene& scene : kScenes) {
    const auto data = cap(scene, 4);
    const metrology::FittedSphere fit = metrology::fitSphere({data, {}});
    ASSERT_TRUE(fit.determined) << reports::words(fit.reason);
    const Reference exact = leastSquares(
        Kind::sphere, data, {centreOf(scene).cast<Real>(), kAxis.cast<Real>(), static_cast<Real>(scene.size)});
    const auto centre = static_cast<double>((fit.sphere.centre.cast<Real>() - exact.point).norm());
    EXPECT_LT(centre, allowed(scene)) << scene.degrees << " " << scene.offset;
    EXPECT_LT(std::abs(static_cast<double>(fit.sphere.radius - exact.radius)), allowed(scene)) << scene.degrees;
    worst = std::max(worst, centre / allowed(scene));
  }
  std::printf("spheres against long double: centre %.2f of what is allowed\n", worst);
}

TEST(Precision, CylindersOnShortArcsFarAway) {
  double worst = 0.0;
  for (const Scene& scene : kScenes) {
    const auto data = points(scene, 1.0, 5);
    const metrology::FittedCylinder fit = metrology::fitCylinder({data, {}});
    ASSERT_TRUE(fit.determined) << scene.degrees << ": " << reports::words(fit.reason);
    const Reference exact = leastSquares(
        Kind::cylinder, data, {centreOf(scene).cast<Real>(), kAxis.cast<Real>(), static_cast<Real>(scene.size)});
    const Vector from = fit.cylinder.axis.point.cast<Real>() - exact.point;
    const auto miss = static_cast<double>(from.cross(exact.direction).norm());
    const auto direction = static_cast<double>(fit.cylinder.axis.direction.cast<Real>().cross(exact.direction).norm());
    EXPECT_LT(miss, allowed(scene)) << scene.degrees << " " << scene.offset;
    EXPECT_LT(std::abs(static_cast<double>(fit.cylinder.radius - exact.radius)), allowed(scene)) << scene.degrees;
    EXPECT_LT(direction, 1e-14) << scene.degrees << " " << scene.offset;
    worst = std::max(worst, miss / allowed(scene));
  }
  std::printf("cylinders against long double: axis %.2f of what is allowed\n", worst);
}

}  // namespace precision_test
}  // namespace stiffscope
