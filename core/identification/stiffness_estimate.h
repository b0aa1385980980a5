#pragma once

#include <string>

#include "core/identification/identifiability.h"

namespace stiffscope {

/// Joint stiffnesses by one method, from one set of load cases.
struct StiffnessEstimate {
  Vector6d compliance = Vector6d::Zero();  ///< c = 1/k, rad/Nm; 0 for a joint that is not identifiable
  Matrix6d covariance = Matrix6d::Zero();  ///< of c, from the scatter between postures
  JointMask identifiable{};
  double condition = 0.0;     ///< of the stacked equations, columns scaled to unit length
  double rms_residual = 0.0;  ///< plain, of the positions the method fits, per coordinate, m
  double sigma = 0.0;         ///< the same over degrees of freedom, m

  double stiffness(int joint) const { return 1.0 / compliance[joint]; }
  /// Standard uncertainty of k to first order, sd(c) / c^2.
  double stiffnessSd(int joint) const;
  /// What a reader must know of the entry: "negative", "imprecise" (standard deviation above the value), or empty.
  std::string mark(int joint) const;
};

/// Covariance of least squares c = N^-1 sum A_p^T b_p from the scatter between postures, which errors shared within a
/// posture (its unloaded readings, its wrench) do not fool: sum of g_p g_p^T, g_p = N^-1 A_p^T (b_p - A_p c), times
/// n/(n - u), n postures and u unknowns divided among three coordinates.
Matrix6d scatterCovariance(const std::vector<Vector6d>& influences, int unknowns);

/// g_p of one posture.
Vector6d influence(const CaseEquations& equations, const NormalEquations& sum, const Vector6d& compliance,
                   const JointMask& unknown);

/// Fills rms_residual and sigma from the positional residuals of `equations`.
void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate);

}  // namespace stiffscope
