#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// The linear equations of one load case, A c = b, c = (1/k_1 .. 1/k_n): paper (12) with one column a joint,
/// A_j = J_m,j (J_w^T W)_j. Rows are displacements in R0 (m), and rotations (rad) where a method uses them.
struct CaseEquations {
  JointRows matrix;
  Eigen::VectorXd right;
  int posture = -1;  ///< equations of the same one (LoadCase::pose) share its errors; -1: nothing shared
};

/// Joint torques of each load case, paper (2), Nm: J_w^T W.
std::vector<JointVector> jointTorques(const std::vector<LoadCase>& cases);

/// The same plus K_c c (J_w^T W + K_c ...): the torque by which the springs really are turned when the load's
/// and the own weight's torque changes as the joints give, so that A c = J_m (K - K_c)^-1 J_w^T W
/// (docs/method.md, The model). `compliance` c is the current estimate; the equations stay linear for the next one.
std::vector<JointVector> jointTorquesWithGeometricStiffness(const frames::LoadingGeometry& geometry,
                                                            const std::vector<LoadCase>& cases,
                                                            const JointVector& compliance);

/// One round of the loads settling at the compliances c: torques by K_c; wrenches whose turn is not measured
/// directed by that of the model (force and moment were read in axes that have turned with their body by c
/// torque; first order in the deflection, as K_c is); torques by those; and the axes of the Jacobians at the
/// middle of the displacement.
void updateLoadedConfiguration(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                               std::vector<LoadCase>& cases, std::vector<JointVector>& torques);

/// Takes each case's Jacobians at the middle of its displacement: q_sagged + c torque / 2.
void takeJacobiansAtMiddle(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                           const std::vector<JointVector>& torques, std::vector<LoadCase>& cases);

/// J_m diag(torque) of the positional rows of a point of the flange body.
PointJacobian pointRows(const robot::ArmAxes& axes, const Eigen::Vector3d& point, const JointVector& torque);

/// A^T A and A^T b of one load case or of a sum of them.
struct NormalEquations {
  JointMatrix matrix;
  JointVector right;

  /// Of nothing yet: the first that is added says how many joints there are.
  NormalEquations() = default;
  explicit NormalEquations(Eigen::Index joints)
      : matrix(JointMatrix::Zero(joints, joints)), right(JointVector::Zero(joints)) {}
  NormalEquations(JointMatrix of_matrix, JointVector of_right)
      : matrix(std::move(of_matrix)), right(std::move(of_right)) {}

  NormalEquations& operator+=(const NormalEquations& other);
  /// Of three rows more, a point's.
  void add(const PointJacobian& rows, const Eigen::Vector3d& values);
};

NormalEquations normalEquations(const CaseEquations& equations);
NormalEquations normalEquations(const std::vector<CaseEquations>& equations);
NormalEquations sumOf(const std::vector<NormalEquations>& normal);

/// A normal matrix with columns scaled to unit length; joints that are no unknowns have scale 0 and a unit
/// diagonal.
struct ScaledNormal {
  JointMatrix matrix;
  JointVector scale;
};

ScaledNormal scaledNormal(const JointMatrix& matrix, const robot::JointMask& unknown);

/// Least squares over the joints of the mask, the others zero. Columns are scaled to unit length first.
JointVector solveNormal(const NormalEquations& sum, const robot::JointMask& unknown);

/// Condition number (2-norm) of the stacked matrix over the joints of the mask, columns scaled to unit
/// length.
double conditionNumber(const std::vector<CaseEquations>& equations, const robot::JointMask& unknown);

/// P_wrist in one load case, unloaded and loaded, by trilateration from three reflectors; R0, m.
struct WristMove {
  Eigen::Vector3d unloaded = Eigen::Vector3d::Zero();
  Eigen::Vector3d loaded = Eigen::Vector3d::Zero();

  Eigen::Vector3d displacement() const { return loaded - unloaded; }
};

/// Where the arm's model has P_wrist unloaded; `centre_at_zero`: at joints zero, a point of the body that carries the
/// wrist.
Eigen::Vector3d modelledWrist(const robot::Robot& arm, const LoadCase& load_case,
                              const Eigen::Vector3d& centre_at_zero);

/// (13)-(20) with the radii of the wrist sweep (`radii` by target, NaN where unknown), on the three
/// reflectors of the case that span the largest triangle; of the two roots the one nearer to `modelled`
/// (modelledWrist). Empty with fewer than three reflectors of known radius, or in one line.
std::optional<WristMove> wristMove(const LoadCase& load_case, const std::vector<double>& radii,
                                   const Eigen::Vector3d& modelled);

/// How P_wrist follows small displacements of the case's reflectors, three columns each in their order: the derivative
/// of (13)-(20), taken in the middle of the move. Zero columns for reflectors that wristMove does not use.
Eigen::Matrix<double, 3, Eigen::Dynamic> wristByReflectors(const LoadCase& load_case, const std::vector<double>& radii,
                                                           const WristMove& wrist);

/// The equations of P_wrist's displacement. Columns of the wrist's joints are nearly zero: their axes meet there.
CaseEquations wristEquations(const LoadCase& load_case, const WristMove& wrist, const JointVector& torque);

}  // namespace stiffscope::identification
