#include "metrology/sphere_fit.h"

#include <algorithm>
#include <cmath>

#include "metrology/least_squares.h"
#include "metrology/measured_points.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

namespace {

/// Taubin's common centre; empty, with the reason, where the points lie in one plane.
std::optional<SpheresModel> spheresStart(const LocalPoints& local, Remark& reason) {
  const PrincipalAxes axes = principalAxes(local);
  const bool thick = spreads(axes.spread[0], axes.spread[2], local);
  const auto centre = thick ? algebraicCentre<3>(local, axes.directions) : std::nullopt;
  if (!centre) {
    reason = Remark(RemarkId::reflector_in_one_plane);
    return std::nullopt;
  }
  return SpheresModel(axes.directions * *centre);
}

/// Mean distance of each group from the centre.
Eigen::RowVectorXd firstRadii(const Eigen::Vector3d& centre, const LocalPoints& local) {
  Eigen::RowVectorXd radii = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(local.groups.size()));
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    double sum = 0.0;
    for (const Eigen::Vector3d& point : local.groups[k].points) sum += (point - centre).norm();
    radii[static_cast<Eigen::Index>(k)] = sum / static_cast<double>(local.groups[k].points.size());
  }
  return radii;
}

}  // namespace

SphereFit fitSpheres(const std::vector<SpherePoints>& spheres) {
  SphereFit fit;
  for (const SpherePoints& sphere : spheres) {
    if (sphere.points.size() < 4) fit.reason = Remark(RemarkId::reflector_under_four);
  }
  if (!fit.reason.empty()) return fit;
  const LocalPoints local = localPoints(spheres.data(), spheres.size());
  fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  auto model = spheresStart(local, fit.reason);
  if (!model) return fit;

  const Estimate estimate = fitLeastSquares(*model, local, firstRadii(model->centre, local));
  fit.degrees_of_freedom = estimate.degreesOfFreedom();
  if (!tellsUncertainty(estimate, local)) {
    fit.reason = Remark(RemarkId::too_few_for_centre);
    return fit;
  }
  if (!estimate.determined) {
    fit.reason = Remark(RemarkId::centre_not_determined);
    return fit;
  }
  fit.centre = local.origin + local.scale * model->centre;
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    fit.radii.push_back(local.scale * estimate.own(0, static_cast<Eigen::Index>(k)));
  }
  fit.covariance = local.scale * local.scale * varianceFactor(estimate, local.weighted()) * estimate.cofactor;
  fit.rms = local.scale * std::sqrt(estimate.plain / estimate.residuals);
  const int dof = fit.degrees_of_freedom;
  fit.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? estimate.chi2 / dof : 0.0;
  fit.determined = true;
  return fit;
}

FittedSphere fitSphere(const MeasuredPoints& points) {
  FittedSphere fit;
  fit.method = Remark(RemarkId::sphere_radial);
  const LocalPoints local = localPoints(&points, 1);
  fit.reason = tooFewReadings(4, points.points.size());
  if (fit.reason.empty()) fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  auto model = spheresStart(local, fit.reason);
  if (!model) {
    fit.reason = Remark(RemarkId::centre_in_one_plane);
    return fit;
  }
  const Estimate estimate = fitLeastSquares(*model, local, firstRadii(model->centre, local));
  if (!describeQuality(estimate, local, fit)) return fit;
  if (tellsUncertainty(estimate, local)) {
    fit.covariance = local.scale * local.scale * varianceFactor(estimate, local.weighted()) * estimate.cofactor;
    if (!curved(local.scale * estimate.own(0, 0), std::sqrt((*fit.covariance)(3, 3)))) {
      fit.reason = Remark(RemarkId::radius_of_plane);
      fit.covariance.reset();
      return fit;
    }
  }
  fit.sphere = {local.origin + local.scale * model->centre, local.scale * estimate.own(0, 0)};
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope::metrology
