#pragma once

#include <array>
#include <vector>

#include "core/robot/kinematics.h"

namespace stiffscope::robot {

/// Translational stiffness of a point in one direction: what a force along it meets, N/m.
struct PrincipalStiffness {
  double stiffness = 0.0;                               ///< infinite where joint springs do not let the point move
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, its largest component positive
};

/// The springs of the joints as seen at one point of the flange body, in the axes of the Jacobian's base
/// frame.
struct CartesianStiffness {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m
  /// C_x = J (K_theta - K_c)^-1 J^T: displacement (m) and rotation (rad) by force (N) and moment (Nm) at the
  /// point.
  Matrix6d compliance = Matrix6d::Zero();
  bool invertible =
      false;  ///< false in a singularity, of fewer than six joints, and where a rigid joint locks a direction
  Matrix6d stiffness = Matrix6d::Zero();  ///< K_x = C_x^-1, paper (4); (6) without K_c. Zero if not invertible
  /// By the translational block of C_x: a force alone acts, the flange is free to turn. Softest direction
  /// first.
  std::array<PrincipalStiffness, 3> principal;
  double anisotropy() const { return principal[2].stiffness / principal[0].stiffness; }
};

/// `jacobian` at `point`, `compliance` c = 1/k of the joints (rad/Nm; 0 counts as rigid), `geometric` K_c
/// (Nm/rad, none: paper (6)). Symmetric where K_c is, which a moment that keeps its direction spoils a
/// little. The principal directions are those of the symmetric part.
CartesianStiffness cartesianStiffness(const Eigen::Vector3d& point, const Jacobian& jacobian,
                                      const JointVector& compliance, const JointMatrix& geometric = {});

/// Principal stiffnesses of a translational compliance (m/N, its symmetric part) within the span of orthonormal
/// columns: the stationary values of 1 / (d^T C d) over unit d there, softest first, as many as there are columns.
std::vector<PrincipalStiffness> principalStiffnessWithin(const Eigen::Matrix3d& compliance,
                                                         const Eigen::Matrix3Xd& basis);

/// By how much K_c changes the springs at the point: the Frobenius norm of the change of C_x's translational
/// block, over that of the block without K_c. Dumas et al. place the robot where this may be neglected.
double geometricStiffnessShare(const CartesianStiffness& with, const CartesianStiffness& without);

}  // namespace stiffscope::robot
