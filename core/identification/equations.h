#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/load_case.h"

namespace stiffscope {

/// The linear equations of one load case, A c = b, c = (1/k_1 .. 1/k_6): paper (12) with one column a joint,
/// A_j = J_m,j (J_w^T W)_j. Rows are displacements in R0 (m), and rotations (rad) where a method uses them.
struct CaseEquations {
  Eigen::Matrix<double, Eigen::Dynamic, 6> matrix;
  Eigen::VectorXd right;
  int posture = -1;  ///< equations of the same one (LoadCase::pose) share its errors; -1: nothing shared
};

/// Joint torques of each load case, paper (2), Nm: J_w^T W.
std::vector<Vector6d> jointTorques(const std::vector<LoadCase>& cases);

/// The same plus K_c c (J_w^T W + K_c ...): the torque by which the springs really are turned when the load's
/// and the own weight's torque changes as the joints give, so that A c = J_m (K - K_c)^-1 J_w^T W (method:
/// Unknowns). `compliance` c is the current estimate; the equations stay linear for the next one.
std::vector<Vector6d> jointTorquesWithGeometricStiffness(const LoadingGeometry& geometry,
                                                         const std::vector<LoadCase>& cases,
                                                         const Vector6d& compliance);

/// One round of the loads settling at the compliances c: torques by K_c; wrenches whose turn is not measured
/// directed by that of the model (force and moment were read in axes that have turned with their body by c
/// torque; first order in the deflection, as K_c is); torques by those; and the axes of the Jacobians at the
/// middle of the displacement.
void settleLoads(const LoadingGeometry& geometry, const Vector6d& compliance, std::vector<LoadCase>& cases,
                 std::vector<Vector6d>& torques);

/// Takes each case's Jacobians at the middle of its displacement: q_sagged + c torque / 2.
void takeJacobiansAtMiddle(const LoadingGeometry& geometry, const Vector6d& compliance,
                           const std::vector<Vector6d>& torques, std::vector<LoadCase>& cases);

/// J_m diag(torque) of the positional rows of a point of the flange body.
Matrix36d pointRows(const ArmAxes& axes, const Eigen::Vector3d& point, const Vector6d& torque);

}  // namespace stiffscope
