#pragma once

#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// Between two numbers; infinite where it is open.
struct CoverageInterval {
  double low = 0.0, high = 0.0;
  bool holds(double value) const { return low <= value && value <= high; }
};

/// Coverage of the intervals that reports state.
inline constexpr double kStatedCoverage = 0.95;

/// c -+ t u(c), t the quantile of Student's distribution with the estimate's effective degrees of freedom. Infinite
/// where the postures are too few for an uncertainty.
CoverageInterval complianceInterval(const StiffnessEstimate& estimate, int joint, double coverage = kStatedCoverage);

/// 1/c over an interval of compliances. Where that includes zero, the data only says that the joint is stiffer than
/// 1/high: the result is open above. Both ends negative for an interval that lies below zero.
CoverageInterval stiffnessInterval(const CoverageInterval& compliance);
CoverageInterval stiffnessInterval(const StiffnessEstimate& estimate, int joint, double coverage = kStatedCoverage);

/// Correlation of the compliances; rows and columns of joints that are not identifiable are zero.
Matrix6d correlation(const StiffnessEstimate& estimate);

}  // namespace stiffscope
