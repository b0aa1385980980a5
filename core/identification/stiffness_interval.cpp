#include "core/identification/stiffness_interval.h"

#include <cmath>
#include <limits>

#include "core/identification/coverage_factor.h"

namespace stiffscope {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

CoverageInterval complianceInterval(const StiffnessEstimate& estimate, int joint, double coverage) {
  const double reach = coverageFactor(estimate, joint, coverage) * std::sqrt(estimate.covariance(joint, joint));
  if (!std::isfinite(reach)) return {-kInfinite, kInfinite};
  return {estimate.compliance[joint] - reach, estimate.compliance[joint] + reach};
}

CoverageInterval stiffnessInterval(const CoverageInterval& compliance) {
  if (!std::isfinite(compliance.low) || !std::isfinite(compliance.high)) return {-kInfinite, kInfinite};
  if (compliance.low > 0.0 || compliance.high < 0.0) return {1.0 / compliance.high, 1.0 / compliance.low};
  return {compliance.high > 0.0 ? 1.0 / compliance.high : -kInfinite, kInfinite};
}

CoverageInterval stiffnessInterval(const StiffnessEstimate& estimate, int joint, double coverage) {
  return stiffnessInterval(complianceInterval(estimate, joint, coverage));
}

Matrix6d correlation(const StiffnessEstimate& estimate) {
  Vector6d scale = Vector6d::Zero();
  for (int j = 0; j < 6; ++j) {
    const double variance = estimate.covariance(j, j);
    if (variance > 0.0) scale[j] = 1.0 / std::sqrt(variance);
  }
  return scale.asDiagonal() * estimate.covariance * scale.asDiagonal();
}

}  // namespace stiffscope
