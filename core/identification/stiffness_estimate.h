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
  /// What a reader must know of the entry: "negative", "imprecise" (standard deviation above the value), or
  /// empty.
  std::string mark(int joint) const;
};

/// Covariance of least squares from the scatter between postures, which errors shared within a posture (its
/// unloaded readings, its wrench) do not fool: the sum of g_p g_p^T over the influences g_p of the postures.
/// Not a number with fewer than two postures beyond those that `unknowns` take up (a posture gives three coordinates).
Matrix6d scatterCovariance(const std::vector<Vector6d>& influences, const JointMask& unknown);

/// g_p = N^-1 A_p^T (I - H_p)^-1/2 (b_p - A_p c), H_p = A_p N^-1 A_p^T: how one posture moves the estimate.
/// The root makes up for what the posture pulled the fit towards itself (Bell and McCaffrey 2002, CR2), which
/// matters for few postures.
Vector6d influence(const CaseEquations& equations, const NormalEquations& sum, const Vector6d& compliance,
                   const JointMask& unknown);

/// Fills rms_residual and sigma from the positional residuals of `equations`.
void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate);

}  // namespace stiffscope
