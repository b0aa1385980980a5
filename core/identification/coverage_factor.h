#pragma once

#include <Eigen/Core>

#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// k of U = k u for a normal error whose estimated variance is a sum of squares of correlated normal numbers: weights, the
/// eigenvalues of the numbers' covariance, positive. By Craig's integral, P(|z| > k s) = 2/pi times the
/// integral over 0..pi/2 of prod (1 + k^2 w_i / sin^2 t)^-1/2, w normalised to sum one; exact for independent z and s.
double coverageFactor(const Eigen::VectorXd& weights, double coverage);

/// `count` more weights of one size; count need not be whole.
struct EqualWeights {
  double weight = 0.0;
  double count = 0.0;
};
double coverageFactor(const Eigen::VectorXd& weights, const EqualWeights& more, double coverage);

/// The same for Student's t of any degrees of freedom (weights 1/nu, nu times).
double studentFactor(double dof, double coverage);

/// Of a joint's compliance: Student's, with the estimate's effective degrees of freedom. NaN where there are none.
double coverageFactor(const StiffnessEstimate& estimate, int joint, double coverage);

/// Degrees of freedom of Student's t with the same factor at the stated coverage as a sum of squares of influences with
/// that covariance. Satterthwaite's match the second moment instead, and where one posture makes most of a
/// scatter (fewer than five degrees) state intervals that hold the truth 98 % of the time instead of 95 %.
double matchedDof(const Eigen::MatrixXd& influence_covariance, const EqualWeights& more = {});

}  // namespace stiffscope
