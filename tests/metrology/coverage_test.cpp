#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include "metrology/axis_fit.h"
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/sphere_fit.h"
#include "tests/metrology/simulated_points.h"

// Do the stated covariances say the truth? Many measurements are made of one known axis or centre; the 95 %
// region of each fit (chi-square of as many degrees of freedom as parameters) must hold the truth in 93-97 %
// of them: 2000 draws have a standard error of 0.5 % on 95 %, and the factor chi2/dof, which is applied only
// where above 1, adds about 1 % (here 68 and 54 degrees of freedom).

namespace stiffscope {
namespace coverage_test {

constexpr int kFits = 2000;
constexpr double kChiSquare3 = 7.8147, kChiSquare4 = 9.4877;  // 95 % quantiles
constexpr double kAlong = 6e-6, kAcross = 2.5e-5;             // m: a tracker's noise at a few metres

const Eigen::Vector3d kCentre(3.2, -1.3, 0.8);  // the tracker stands at the origin
const Eigen::Vector3d kAxis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();

/// (shift_u, shift_v, tilt_u, tilt_v) from the fit to the truth, by the definition of MeasuredLine.
Eigen::Vector4d errorOf(const metrology::MeasuredLine& fit) {
  const Eigen::Vector3d towards = kAxis * (kAxis.dot(fit.line.direction) < 0.0 ? -1.0 : 1.0);
  const double along = towards.dot(fit.line.direction);
  const double to_plane = fit.line.direction.dot(fit.line.point - kCentre) / along;
  const Eigen::Vector3d pierced = kCentre + to_plane * towards - fit.line.point;
  return {fit.across_u.dot(pierced), fit.across_v.dot(pierced), fit.across_u.dot(towards) / along,
          fit.across_v.dot(towards) / along};
}

double axisCoverage(double degrees) {
  Noise noise(static_cast<std::uint64_t>(degrees));
  const std::array<double, 3> radii{1.8, 2.0, 1.9}, heights{0.2, 0.0, -0.25}, from{0.3, 0.35, 0.25};
  constexpr int kStops = 13;
  int inside = 0;
  for (int k = 0; k < kFits; ++k) {
    std::vector<metrology::CirclePoints> circles(3);
    for (std::size_t target = 0; target < 3; ++target) {
      for (int i = 0; i < kStops; ++i) {
        const Eigen::Vector3d point =
            onCircle(kCentre, kAxis, radii[target], heights[target], from[target] + radians(degrees) * i / kStops);
        const Eigen::Matrix3d covariance = seenFromOrigin(point, kAlong, kAcross);
        circles[target].points.push_back(point + noise.draw(covariance));
        circles[target].covariances.push_back(covariance);
      }
    }
    const metrology::AxisFit fit = metrology::fitAxis(circles);
    if (!fit.determined) continue;
    const Eigen::Vector4d error = errorOf(fit.axis);
    inside += error.dot(fit.axis.covariance.ldlt().solve(error)) < kChiSquare4;
  }
  return static_cast<double>(inside) / kFits;
}

TEST(Coverage, AxisOverAnArcOf40Degrees) {
  const double coverage = axisCoverage(40.0);
  EXPECT_GT(coverage, 0.93);
  EXPECT_LT(coverage, 0.97);
}

TEST(Coverage, AxisOverAnArcOf90Degrees) {
  const double coverage = axisCoverage(90.0);
  EXPECT_GT(coverage, 0.93);
  EXPECT_LT(coverage, 0.97);
}

TEST(Coverage, AxisOverAFullTurn) {
  const double coverage = axisCoverage(360.0);
  EXPECT_GT(coverage, 0.93);
  EXPECT_LT(coverage, 0.97);
}

TEST(Coverage, CommonCentreOfSpheres) {
  Noise noise(77);
  const std::array<double, 3> radii{0.55, 0.6, 0.5};
  constexpr int kStops = 20;
  int centre_inside = 0, all_inside = 0;
  constexpr double kChiSquare6 = 12.5916;
  for (int k = 0; k < kFits; ++k) {
    std::vector<metrology::SpherePoints> spheres(3);
    for (std::size_t target = 0; target < 3; ++target) {
      for (int i = 0; i < kStops; ++i) {
        // A wrist reaches about a third of the sphere.
        Eigen::Vector3d outward = noise.direction();
        while (outward.dot(kAxis) < 0.3) outward = noise.direction();
        const Eigen::Vector3d point = kCentre + radii[target] * outward;
        const Eigen::Matrix3d covariance = seenFromOrigin(point, kAlong, kAcross);
        spheres[target].points.push_back(point + noise.draw(covariance));
        spheres[target].covariances.push_back(covariance);
      }
    }
    const metrology::SphereFit fit = metrology::fitSpheres(spheres);
    if (!fit.determined) continue;
    Eigen::VectorXd error(6);
    error << kCentre - fit.centre, radii[0] - fit.radii[0], radii[1] - fit.radii[1], radii[2] - fit.radii[2];
    const Eigen::Vector3d of_centre = error.head<3>();
    centre_inside += of_centre.dot(fit.covariance.topLeftCorner<3, 3>().ldlt().solve(of_centre)) < kChiSquare3;
    all_inside += error.dot(fit.covariance.ldlt().solve(error)) < kChiSquare6;
  }
  EXPECT_GT(centre_inside, 0.93 * kFits);
  EXPECT_LT(centre_inside, 0.97 * kFits);
  EXPECT_GT(all_inside, 0.93 * kFits);
  EXPECT_LT(all_inside, 0.97 * kFits);
}

constexpr double kChiSquare5 = 11.0705, kChiSquare6 = 12.5916;

/// error' C^+ error with the inverse taken on the `rank` directions in which the covariance has an extent.
/// Rows are brought to one size first: lengths of micrometres stand beside angles.
double squaredDistance(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance, Eigen::Index rank) {
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd even = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(even);
  const Eigen::VectorXd along = (eigen.eigenvectors().transpose() * (scale.asDiagonal() * error)).tail(rank);
  return along.cwiseAbs2().cwiseQuotient(eigen.eigenvalues().tail(rank)).sum();
}

/// Readings of a tracker in the origin: 6 um along its beam, 25 um across.
metrology::MeasuredPoints measured(const std::vector<Eigen::Vector3d>& ideal, Noise& noise) {
  metrology::MeasuredPoints points;
  for (const Eigen::Vector3d& point : ideal) {
    points.covariances.push_back(seenFromOrigin(point, kAlong, kAcross));
    points.points.push_back(point + noise.draw(points.covariances.back()));
  }
  return points;
}

std::vector<Eigen::Vector3d> arcPoints(double degrees, double height) {
  std::vector<Eigen::Vector3d> ideal;
  constexpr int kStops = 60;
  for (int i = 0; i < kStops; ++i) {
    ideal.push_back(onCircle(kCentre, kAxis, 1.2, height * ((i % 5) - 2.0), radians(degrees) * i / kStops));
  }
  return ideal;
}

void expectCoverage(const std::string& what, int inside) {
  std::printf("coverage of %s: %.1f %%\n", what.c_str(), 100.0 * inside / kFits);
  EXPECT_GT(inside, 0.93 * kFits) << what;
  EXPECT_LT(inside, 0.97 * kFits) << what;
}

TEST(Coverage, Circles) {
  for (const metrology::CircleStrategy strategy :
       {metrology::CircleStrategy::full, metrology::CircleStrategy::plane_first}) {
    for (const double degrees : {40.0, 90.0, 360.0}) {
      Noise noise(static_cast<std::uint64_t>(degrees));
      const auto ideal = arcPoints(degrees, 0.0);
      int inside = 0;
      for (int k = 0; k < kFits; ++k) {
        const metrology::FittedCircle fit = metrology::fitCircle(measured(ideal, noise), strategy);
        if (!fit.determined) continue;
        Eigen::VectorXd error(7);
        error << fit.circle.centre - kCentre, fit.circle.normal - kAxis, fit.circle.radius - 1.2;
        inside += squaredDistance(error, *fit.covariance, 6) < kChiSquare6;
      }
      expectCoverage(std::string(strategy == metrology::CircleStrategy::full ? "full" : "plane-first") +
                         " circles over " + std::to_string(static_cast<int>(degrees)) + " degrees",
                     inside);
    }
  }
}

TEST(Coverage, Spheres) {
  for (const double degrees : {40.0, 90.0, 360.0}) {  // opening of the cap
    Noise noise(static_cast<std::uint64_t>(degrees));
    std::vector<Eigen::Vector3d> ideal;
    while (ideal.size() < 60) {
      const Eigen::Vector3d outward = noise.direction();
      if (outward.dot(kAxis) > std::cos(radians(0.5 * degrees))) ideal.push_back(kCentre + 0.6 * outward);
    }
    int inside = 0;
    for (int k = 0; k < kFits; ++k) {
      const metrology::FittedSphere fit = metrology::fitSphere(measured(ideal, noise));
      if (!fit.determined) continue;
      Eigen::VectorXd error(4);
      error << fit.sphere.centre - kCentre, fit.sphere.radius - 0.6;
      inside += squaredDistance(error, *fit.covariance, 4) < kChiSquare4;
    }
    expectCoverage("spheres, caps of " + std::to_string(static_cast<int>(degrees)) + " degrees", inside);
  }
}

TEST(Coverage, CylinderAxes) {
  for (const double degrees : {40.0, 90.0, 360.0}) {
    Noise noise(static_cast<std::uint64_t>(degrees));
    const auto ideal = arcPoints(degrees, 0.2);
    int inside = 0;
    for (int k = 0; k < kFits; ++k) {
      const metrology::FittedCylinder fit = metrology::fitCylinder(measured(ideal, noise));
      if (!fit.determined) continue;
      // The true axis where it pierces the plane across the fitted one at the fitted point.
      const metrology::Line& axis = fit.cylinder.axis;
      const double along = axis.direction.dot(axis.point - kCentre) / axis.direction.dot(kAxis);
      Eigen::VectorXd error(7);
      error << axis.point - (kCentre + along * kAxis), axis.direction - kAxis, fit.cylinder.radius - 1.2;
      inside += squaredDistance(error, *fit.covariance, 5) < kChiSquare5;
    }
    expectCoverage("cylinders over " + std::to_string(static_cast<int>(degrees)) + " degrees", inside);
  }
}

}  // namespace coverage_test
}  // namespace stiffscope
