#include "metrology/sphere_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace stiffscope {

namespace {

/// |x|^2 - 2 c.x + s_k = 0 is linear in the centre; subtracting each sphere's means removes s_k.
bool algebraicCentre(const std::vector<SpherePoints>& spheres, Eigen::Vector3d& centre) {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& sphere : spheres) {
    for (const auto& point : sphere.points) origin += point, count += 1.0;
  }
  origin /= count;
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& sphere : spheres) {
    const double n = static_cast<double>(sphere.points.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double mean_square = 0.0;
    for (const auto& point : sphere.points) {
      mean += (point - origin) / n;
      mean_square += (point - origin).squaredNorm() / n;
    }
    for (const auto& point : sphere.points) {
      const Eigen::Vector3d from_mean = point - origin - mean;
      normal_matrix += from_mean * from_mean.transpose();
      right += 0.5 * ((point - origin).squaredNorm() - mean_square) * from_mean;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal_matrix);
  constexpr double kFlat = 1e-12;  // squared ratio of the least to the largest spread: points in one plane
  if (!(eigen.eigenvalues()[0] > kFlat * eigen.eigenvalues()[2])) return false;
  centre = origin + normal_matrix.ldlt().solve(right);
  return true;
}

struct Step {
  Eigen::MatrixXd normal_matrix;
  Eigen::VectorXd right;
  double chi2 = 0.0, plain = 0.0;
  int residuals = 0;
};

Step linearise(const std::vector<SpherePoints>& spheres, const SphereFit& fit) {
  const int size = 3 + static_cast<int>(spheres.size());
  Step step{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const int at = 3 + static_cast<int>(k);
    for (std::size_t i = 0; i < spheres[k].points.size(); ++i) {
      const Eigen::Vector3d from_centre = spheres[k].points[i] - fit.centre;
      const double radius = from_centre.norm();
      const Eigen::Vector3d outward = from_centre / radius;
      const double residual = radius - fit.radii[k];
      const double weight =
          spheres[k].covariances.empty() ? 1.0 : 1.0 / (outward.dot(spheres[k].covariances[i] * outward));
      step.plain += residual * residual;
      step.chi2 += weight * residual * residual;
      ++step.residuals;
      step.normal_matrix.topLeftCorner<3, 3>() += weight * outward * outward.transpose();
      step.normal_matrix.block<3, 1>(0, at) += weight * outward;
      step.normal_matrix(at, at) += weight;
      step.right.head<3>() += weight * residual * outward;
      step.right[at] += weight * residual;
    }
    step.normal_matrix.block<1, 3>(at, 0) = step.normal_matrix.block<3, 1>(0, at).transpose();
  }
  return step;
}

}  // namespace

SphereFit fitSpheres(const std::vector<SpherePoints>& spheres) {
  SphereFit fit;
  for (const auto& sphere : spheres) {
    if (sphere.points.size() < 4) {
      fit.reason = "fewer than four readings of a reflector";
      return fit;
    }
  }
  if (spheres.empty() || !algebraicCentre(spheres, fit.centre)) {
    fit.reason = spheres.empty() ? "no readings" : "the readings of a reflector lie in one plane";
    return fit;
  }
  for (const auto& sphere : spheres) {
    double sum = 0.0;
    for (const auto& point : sphere.points) sum += (point - fit.centre).norm();
    fit.radii.push_back(sum / static_cast<double>(sphere.points.size()));
  }
  Step step;
  constexpr int kMostSteps = 50;
  for (int iteration = 0; iteration < kMostSteps; ++iteration) {
    step = linearise(spheres, fit);
    const Eigen::VectorXd change = step.normal_matrix.ldlt().solve(step.right);
    if (!change.allFinite()) {
      fit.reason = "the readings do not determine the centre";
      return fit;
    }
    fit.centre += change.head<3>();
    for (std::size_t k = 0; k < fit.radii.size(); ++k) fit.radii[k] += change[3 + static_cast<int>(k)];
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  step = linearise(spheres, fit);
  const int size = static_cast<int>(step.right.size());
  fit.degrees_of_freedom = step.residuals - size;
  const bool weighted = !spheres.front().covariances.empty();
  if (!weighted && fit.degrees_of_freedom < 1) {
    fit.reason = "too few readings for a centre with its uncertainty";
    return fit;
  }
  const double variance = fit.degrees_of_freedom > 0 ? step.chi2 / fit.degrees_of_freedom : 0.0;
  fit.chi2_per_dof = weighted ? variance : 1.0;
  fit.covariance = (weighted ? std::max(1.0, variance) : variance) *
                   step.normal_matrix.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  fit.rms = std::sqrt(step.plain / step.residuals);
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope
