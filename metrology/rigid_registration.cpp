#include "metrology/rigid_registration.h"

#include <Eigen/Dense>
#include <cmath>

namespace stiffscope {

namespace {

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

RigidRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to) {
  RigidRegistration result;
  if (source.size() < 3 || source.size() != to.size()) {
    result.reason = "fewer than three common points";
    return result;
  }
  const Eigen::Vector3d source_mean = mean(source), to_mean = mean(to);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    cross += (to[i] - to_mean) * (source[i] - source_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  constexpr double kOnOneLine = 1e-12;
  if (!(svd.singularValues()[1] > kOnOneLine * svd.singularValues()[0])) {
    result.reason = "the points lie on one line";
    return result;
  }
  // The sign on the least singular direction keeps the rotation proper (Umeyama 1991).
  Eigen::Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  result.to_from_source.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  result.to_from_source.translation() = to_mean - result.to_from_source.linear() * source_mean;
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (result.to_from_source * source[i] - to[i]).squaredNorm();
  result.rms = std::sqrt(sum / (3.0 * static_cast<double>(source.size())));
  result.determined = true;
  return result;
}

}  // namespace stiffscope
