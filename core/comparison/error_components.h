#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/fitted_day.h"
#include "core/robot/robot.h"

namespace stiffscope::comparison {

/// A fit's equations about where it ended, posture by posture, and what it left: all in parts of the readings'
/// covariance.
struct FitEquations {
  std::vector<std::size_t> postures;  ///< in the day, with readings used
  std::vector<calibration::PostureEquations> equations;
  Eigen::MatrixXd normal_inverse;  ///< of the unknowns, the prior in it

  FitEquations(const calibration::UnloadedDay& day, const calibration::ArmFit& fit);
};

/// What the model leaves, as variances: of each coordinate by itself, and of each joint's angle, rad^2, which moves all
/// reflectors of a posture together. What gears do differs from posture to posture like an error of the angle, and
/// makes a joint's zero more uncertain than errors of single coordinates would.
struct ErrorComponents {
  double coordinate = 1.0;
  Vector6d angle = Vector6d::Zero();
};

/// By the moments r^T M r of the residuals: M the identity, and for each joint the sum over postures of a a^T, a what a
/// turn of it does to the readings. With P what the fit leaves of any error,
///   E(r^T M_k r) = s tr(P M_k P) + sum_l t_l tr(P M_k P M_l),
/// solved for s and t_l; variances that come out negative are none (C. R. Rao's estimators, J. Multivariate Anal. 1
/// (1971) 257, with weights 1). `residuals`: of each posture of `fit`, as long as its equations.
ErrorComponents errorComponents(const FitEquations& fit, const std::vector<Eigen::VectorXd>& residuals);

/// Covariance of the unknowns by such errors: N^-1 J^T S J N^-1, and the prior's share.
Eigen::MatrixXd covarianceBy(const FitEquations& fit, const ErrorComponents& errors);

}  // namespace stiffscope::comparison
