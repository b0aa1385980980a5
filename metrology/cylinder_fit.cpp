#include "metrology/cylinder_fit.h"

#include <algorithm>

#include "metrology/cylinder_starts.h"
#include "metrology/finish_fit.h"
#include "metrology/least_readings.h"

namespace stiffscope {

namespace {

using CylinderEstimate = Estimate<CylindersModel, 1>;

/// Other minima are followed where the algebraic sum does not speak against them by far: it is the geometric
/// one but for weights and curvature.
constexpr double kFarWorse = 100.0;
constexpr std::size_t kMostStarts = 12;

bool sameAxis(const CylinderEstimate& a, const CylinderEstimate& b) {
  constexpr double kSame = 1e-5;  // rad and local units
  const double across = a.model.axis.direction().cross(b.model.axis.direction()).norm();
  return across < kSame && std::abs(a.own[0] - b.own[0]) < kSame * (1.0 + a.own[0]);
}

/// Every cylinder to which a start leads, the least sum first.
std::vector<CylinderEstimate> localMinima(const LocalPoints& local) {
  std::vector<CylinderEstimate> found;
  const std::vector<CylinderStart> starts = cylinderStarts(local, kMostStarts);
  const double rounding = local.rounding + std::numeric_limits<double>::epsilon();
  for (const CylinderStart& start : starts) {
    const double floor = static_cast<double>(local.count()) * rounding * rounding;
    if (start.expected > kFarWorse * (starts.front().expected + floor) && !found.empty()) break;
    CylinderEstimate estimate{start.model, CylinderEstimate::Own::Constant(start.radius)};
    refine(estimate, local);
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const auto& other) { return sameAxis(other, estimate); });
    if (estimate.converged && !known) found.push_back(estimate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
  return found;
}

/// Do the readings speak for the first of the two, at 95 %? Without covariances the noise is not known
/// beforehand, and only sums that are equal to rounding leave the choice open.
bool preferred(const CylinderEstimate& best, const CylinderEstimate& other, const LocalPoints& local) {
  if (local.weighted()) {
    constexpr double kChiSquare1 = 3.8415;
    return other.chi2 > best.chi2 + kChiSquare1;
  }
  const double rounding = 16.0 * (local.rounding + std::numeric_limits<double>::epsilon());
  return other.chi2 > 1.000001 * best.chi2 + static_cast<double>(local.count()) * rounding * rounding;
}

void writeResult(const CylinderEstimate& estimate, const LocalPoints& local, FittedCylinder& fit) {
  const AxisFrame& axis = estimate.model.axis;
  const double along = -axis.direction().dot(axis.point());
  const Eigen::Vector3d direction = largestPositive(axis.direction());
  const double sense = direction.dot(axis.direction()) < 0.0 ? -1.0 : 1.0;
  fit.cylinder = {{local.origin + local.scale * (axis.point() + along * axis.direction()), direction},
                  local.scale * estimate.own[0]};
  if (!tellsUncertainty(estimate, local)) return;
  Eigen::Matrix<double, 7, 5> full;  // (point, direction, radius) by (shifts, tilts, radius)
  full << axis.u(), axis.v(), along * axis.u(), along * axis.v(), Eigen::Vector3d::Zero(),               //
      Eigen::Matrix<double, 3, 2>::Zero(), sense * axis.u(), sense * axis.v(), Eigen::Vector3d::Zero(),  //
      Eigen::Matrix<double, 1, 4>::Zero(), 1.0;
  full.topRows<3>() *= local.scale;
  full.row(6) *= local.scale;
  fit.covariance =
      varianceFactor(estimate, local.weighted()) * (full * estimate.cofactor * full.transpose()).eval();
}

std::string whyNotSignificant(const FittedCylinder& fit) {
  if (!fit.covariance) return {};
  if (std::sqrt(fit.covariance->block<3, 3>(3, 3).trace()) > kNoDirection) {
    return "the direction of the axis is undetermined against the scatter of the readings";
  }
  if (!curved(fit.cylinder.radius, std::sqrt((*fit.covariance)(6, 6)))) {
    return "the radius is undetermined: against their scatter the readings could lie in a plane";
  }
  return {};
}

}  // namespace

FittedCylinder fitCylinder(const MeasuredPoints& points) {
  FittedCylinder fit;
  fit.method = "orthogonal distances, Gauss-Newton from each algebraic minimum, the least sum";
  const LocalPoints local = localPoints(&points, 1);
  fit.reason = tooFewReadings(5, points.points.size());
  if (fit.reason.empty()) fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  const PrincipalAxes axes = principalAxes(local);
  if (!spreads(axes.spread[0], axes.spread[2], local)) {
    fit.reason = spreads(axes.spread[1], axes.spread[2], local)
                     ? "the axis is undetermined: the readings lie in one plane"
                     : "the axis is undetermined: the readings lie on one line";
    return fit;
  }
  const std::vector<CylinderEstimate> minima = localMinima(local);
  if (minima.empty()) {
    fit.reason = "no cylinder is nearest to the readings: the fit does not settle";
    return fit;
  }
  if (!describeQuality(minima.front(), local, fit)) return fit;
  if (minima.size() > 1 && !preferred(minima[0], minima[1], local)) {
    fit.reason = "two different cylinders fit the readings alike";
    return fit;
  }
  writeResult(minima.front(), local, fit);
  fit.reason = whyNotSignificant(fit);
  if (!fit.reason.empty()) {
    fit.cylinder = {};
    fit.covariance.reset();
    return fit;
  }
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope
