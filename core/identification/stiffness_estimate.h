#pragma once

#include <string>
#include <vector>

#include "core/identification/identifiability.h"

namespace stiffscope {

/// What the covariance of the compliances is made of; independent of each other, so that they add.
///
/// `scatter` is the errors that differ between postures, whatever they are: the tracker's noise, the load cell's, the angles',
/// and what joint springs do not explain. The others are errors that all postures share, which no scatter shows:
/// derivatives of the whole solution times the covariance of what was estimated on the way. Two loops are left out, both of
/// a thousandth: noise of the unloaded readings that also calibrate Partial Pose's geometry, and stiffnesses that
/// take the sag off the sweeps they stand on. A load cell's gain, axes and point are taken as declared: the format has
/// no uncertainty for them.
struct CovarianceParts {
  Matrix6d scatter = Matrix6d::Zero();
  Matrix6d frames = Matrix6d::Zero();    ///< the measured axes: R0, links, the flange's place
  Matrix6d wrist = Matrix6d::Zero();     ///< radii about the wrist centre
  Matrix6d geometry = Matrix6d::Zero();  ///< calibrated on the unloaded positions, Partial Pose only
  Matrix6d effects = Matrix6d::Zero();   ///< fitted to the same data and taken off it; zero without any

  Matrix6d total() const { return scatter + frames + wrist + geometry + effects; }
};

/// Joint stiffnesses by one method, from one set of load cases.
struct StiffnessEstimate {
  Vector6d compliance = Vector6d::Zero();  ///< c = 1/k, rad/Nm; 0 for a joint that is not identifiable
  /// Of c: `parts` summed, what scatters between the postures and what they all have in common.
  Matrix6d covariance = Matrix6d::Zero();
  CovarianceParts parts;
  std::vector<Vector6d> influences;             ///< g_p, one a posture
  Vector6d scatter_dof = Vector6d::Zero();      ///< of the scatter, by matchedDof (coverage_factor.h)
  JointMask identifiable{};
  double condition = 0.0;     ///< of the stacked equations, columns scaled to unit length
  double rms_residual = 0.0;  ///< plain, of the positions the method fits, per coordinate, m
  double sigma = 0.0;         ///< the same over degrees of freedom, m

  /// Effective degrees of freedom of a compliance's uncertainty (Welch and Satterthwaite): the shared parts count as
  /// known exactly.
  double dof(int joint) const;

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

/// Puts influences, scatter covariance and its degrees of freedom into an estimate, and the covariance so far.
void setScatter(std::vector<Vector6d> influences, const Vector6d& dof, StiffnessEstimate& estimate);

/// The same of one least-squares problem, a posture each, solved by `estimate.compliance` over `estimate.identifiable`.
void setScatterOfOneStage(const std::vector<NormalEquations>& normal, const NormalEquations& sum,
                          StiffnessEstimate& estimate);

/// Fills rms_residual and sigma from the positional residuals of `equations`.
void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate);

}  // namespace stiffscope
