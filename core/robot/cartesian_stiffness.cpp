#include "core/robot/cartesian_stiffness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "metrology/linear_algebra.h"

namespace stiffscope::robot {

namespace {

template <class Matrix>
std::vector<PrincipalStiffness> principalStiffness(const Matrix& compliance, const Eigen::Matrix3Xd& basis) {
  const Eigen::SelfAdjointEigenSolver<Matrix> own(compliance);
  constexpr double kRounding = 1e-14;  // of the largest: the point cannot move that way
  const double least = kRounding * own.eigenvalues().cwiseAbs().maxCoeff();
  std::vector<PrincipalStiffness> principal(static_cast<std::size_t>(basis.cols()));
  for (std::size_t k = 0; k < principal.size(); ++k) {
    const auto place = basis.cols() - 1 - static_cast<Eigen::Index>(k);  // ascending compliance: softest is last
    const double value = own.eigenvalues()[place];
    principal[k].stiffness = std::abs(value) <= least ? std::numeric_limits<double>::infinity() : 1.0 / value;
    principal[k].direction = basis * own.eigenvectors().col(place);
    Eigen::Index largest = 0;
    principal[k].direction.cwiseAbs().maxCoeff(&largest);
    if (principal[k].direction[largest] < 0.0) principal[k].direction *= -1.0;
  }
  return principal;
}

}  // namespace

std::vector<PrincipalStiffness> principalStiffnessWithin(const Eigen::Matrix3d& compliance,
                                                         const Eigen::Matrix3Xd& basis) {
  if (basis.cols() == 0) return {};
  const Eigen::MatrixXd within = basis.transpose() * (0.5 * (compliance + compliance.transpose())) * basis;
  return basis.cols() == 3 ? principalStiffness(Eigen::Matrix3d(within), basis) : principalStiffness(within, basis);
}

CartesianStiffness cartesianStiffness(const Eigen::Vector3d& point, const Jacobian& jacobian,
                                      const JointVector& compliance, const JointMatrix& geometric) {
  CartesianStiffness result;
  result.point = point;
  const Eigen::Index count = compliance.size();
  JointMatrix joints = compliance.asDiagonal();
  if (geometric.size() > 0) {  // (K - K_c)^-1 = (I - C K_c)^-1 C, which bears rigid joints.
    joints = solveLu(JointMatrix(JointMatrix::Identity(count, count) - compliance.asDiagonal() * geometric), joints);
  }
  result.compliance = jacobian * joints * jacobian.transpose();
  const std::vector<PrincipalStiffness> principal =
      principalStiffnessWithin(result.compliance.topLeftCorner<3, 3>(), Eigen::Matrix3d::Identity());
  std::copy(principal.begin(), principal.end(), result.principal.begin());
  if (count == 6) {
    const Eigen::FullPivLU<Matrix6d> jacobian_lu{Matrix6d(jacobian)};
    result.invertible = jacobian_lu.isInvertible() && (compliance.array() != 0.0).all();
    if (result.invertible) {
      const Matrix6d back = jacobian_lu.inverse();  // (4) as it stands
      Matrix6d springs = Matrix6d(compliance.cwiseInverse().asDiagonal());
      if (geometric.size() > 0) springs -= geometric;
      result.stiffness = back.transpose() * springs * back;
    }
  } else if (count > 6) {  // more springs than directions: (4) has no inverse of J, C_x has
    // Lengths over 1 m: displacements and turns of one size, so that the rank may be judged.
    const Eigen::FullPivLU<Matrix6d> compliance_lu(result.compliance);
    result.invertible = compliance_lu.isInvertible();
    if (result.invertible) result.stiffness = compliance_lu.inverse();
  }
  return result;
}

double geometricStiffnessShare(const CartesianStiffness& with, const CartesianStiffness& without) {
  const Eigen::Matrix3d plain = without.compliance.topLeftCorner<3, 3>();
  const double scale = plain.norm();
  return scale > 0.0 ? (with.compliance.topLeftCorner<3, 3>() - plain).norm() / scale : 0.0;
}

}  // namespace stiffscope::robot
