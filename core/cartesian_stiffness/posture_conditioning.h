#pragma once

#include "core/robot/kinematics.h"

namespace stiffscope {

/// How well conditioned the arm is in one posture: what Dumas et al. (paper, [9]) choose postures by, so that
/// K_c may be neglected and identification not run into a singularity.
struct PostureConditioning {
  double kappa = 0.0;      ///< Frobenius, 1/6 sqrt(tr(J_N^T J_N) tr((J_N^T J_N)^-1)); 1 is isotropic
  double kappa_two = 0.0;  ///< 2-norm: largest over least singular value of J_N
  double dexterity = 0.0;  ///< 1 / kappa, 0 to 1; 0 in a singularity
};

/// Of J_N = diag(1/L I, I) J, paper (8) with J (method: slips), J the Jacobian of a point of the flange body.
/// `length` is the characteristic length L, m. Infinite kappas in a singularity.
PostureConditioning postureConditioning(const Matrix6d& jacobian, double length);

}  // namespace stiffscope
