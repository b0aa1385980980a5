#include <Eigen/Dense>
#include <cmath>

#include "metrology/least_squares.h"
#include "metrology/rigid_registration.h"

namespace stiffscope {

namespace {

/// A rigid motion by differences m(source_i) - to_i, in the local units of `to`. Shared parameters: rotation
/// vector about the local origin, shift, both after the motion.
struct MotionModel {
  static constexpr int kShared = 6, kOwn = 0, kResiduals = 3;
  Eigen::Isometry3d to_from_source;  ///< of source points about their mean, in local units
  const std::vector<Eigen::Vector3d>* source;

  Observation<MotionModel> observe(std::size_t i, const Eigen::Vector3d& to,
                                   const Eigen::Matrix<double, 0, 1>&) const {
    const Eigen::Vector3d moved = to_from_source * (*source)[i];
    Observation<MotionModel> seen;
    seen.residual = moved - to;
    seen.rows << 0.0, moved.z(), -moved.y(), 1.0, 0.0, 0.0,  //
        -moved.z(), 0.0, moved.x(), 0.0, 1.0, 0.0,           //
        moved.y(), -moved.x(), 0.0, 0.0, 0.0, 1.0;
    seen.directions.setIdentity();
    return seen;
  }
  void move(const Eigen::Matrix<double, 6, 1>& step) {
    const double angle = step.head<3>().norm();
    const Eigen::Vector3d about =
        angle > 0.0 ? Eigen::Vector3d(step.head<3>() / angle) : Eigen::Vector3d::UnitX();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, about).toRotationMatrix();
    to_from_source.linear() =
        Eigen::Quaterniond(turn * to_from_source.linear()).normalized().toRotationMatrix();
    to_from_source.translation() = turn * to_from_source.translation() + step.tail<3>();
  }
};

}  // namespace

WeightedRegistration registerRigid(const std::vector<Eigen::Vector3d>& source,
                                   const std::vector<Eigen::Vector3d>& to,
                                   const std::vector<Eigen::Matrix3d>& covariances) {
  WeightedRegistration result;
  static_cast<RigidRegistration&>(result) = registerRigid(source, to);
  if (!result.determined) return result;
  result.determined = false;
  const MeasuredPoints goal{to, covariances};
  const LocalPoints local = localPoints(&goal, 1);
  result.reason = !local.flaw.empty()   ? local.flaw
                  : covariances.empty() ? "the covariances are not one a pair"
                                        : "";
  if (!result.reason.empty()) return result;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : source) source_mean += point / static_cast<double>(source.size());
  std::vector<Eigen::Vector3d> from;
  for (const Eigen::Vector3d& point : source) from.push_back((point - source_mean) / local.scale);

  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.linear() = result.to_from_source.linear();
  start.translation() = (result.to_from_source * source_mean - local.origin) / local.scale;
  Estimate<MotionModel, 1> estimate{{start, &from}};
  refine(estimate, local);
  if (!estimate.determined) {
    result.reason = "the points do not determine the motion";
    return result;
  }
  const Eigen::Isometry3d& found = estimate.model.to_from_source;
  result.to_from_source.linear() = found.linear();
  result.to_from_source.translation() =
      local.origin + local.scale * found.translation() - found.linear() * source_mean;
  Eigen::Matrix<double, 6, 1> units;
  units << 1.0, 1.0, 1.0, local.scale, local.scale, local.scale;
  result.covariance =
      varianceFactor(estimate, true) * (units.asDiagonal() * estimate.cofactor * units.asDiagonal());
  result.pivot = local.origin;
  result.degrees_of_freedom = estimate.degreesOfFreedom();
  result.chi2_per_dof = estimate.chi2 / result.degrees_of_freedom;
  result.rms = local.scale * std::sqrt(estimate.plain / estimate.residuals);
  result.determined = true;
  return result;
}

}  // namespace stiffscope
