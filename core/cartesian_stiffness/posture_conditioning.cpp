#include "core/cartesian_stiffness/posture_conditioning.h"

#include <Eigen/Dense>
#include <limits>

namespace stiffscope {

PostureConditioning postureConditioning(const Matrix6d& jacobian, double length) {
  Matrix6d normalised = jacobian;
  normalised.topRows<3>() /= length;
  const Vector6d singular = Eigen::JacobiSVD<Matrix6d>(normalised).singularValues();
  constexpr double kRounding = 1e-14;  // of the largest: nothing is left of the least
  PostureConditioning result;
  if (singular[5] <= kRounding * singular[0]) {
    result.kappa = result.kappa_two = std::numeric_limits<double>::infinity();
    return result;
  }
  result.kappa = singular.norm() * singular.cwiseInverse().norm() / 6.0;
  result.kappa_two = singular[0] / singular[5];
  result.dexterity = 1.0 / result.kappa;
  return result;
}

}  // namespace stiffscope
