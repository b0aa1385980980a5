#include "metrology/measured_points.h"

#include <cmath>

namespace stiffscope::metrology {

Eigen::Matrix3d TrackerNoise::covarianceAt(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d sight = point - station;
  const double distance = sight.norm();
  const double along = range_fixed + range_per_m * distance;
  const double across = angle_fixed + angle_per_m * distance;
  const Eigen::Matrix3d isotropic = across * across * Eigen::Matrix3d::Identity();
  if (distance == 0.0) return isotropic;
  const Eigen::Vector3d beam = sight / distance;
  return isotropic + (along * along - across * across) * beam * beam.transpose();
}

Eigen::Matrix3d TrackerNoise::covarianceAt(const Eigen::Vector3d& point, const Eigen::Vector3d& from) const {
  return std::isnan(from.x()) ? covarianceAt(point) : seenFrom(from).covarianceAt(point);
}

TrackerNoise TrackerNoise::seenFrom(const Eigen::Vector3d& from) const {
  TrackerNoise noise = *this;
  if (!std::isnan(from.x())) noise.station = from;
  return noise;
}

}  // namespace stiffscope::metrology
