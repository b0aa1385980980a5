#pragma once

#include <vector>

#include "core/identification/estimate.h"
#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// Characteristic lengths beyond which none is looked for, m.
inline constexpr double kShortestLength = 0.05, kLongestLength = 20.0;

/// The characteristic length L of paper (8) (Khan and Angeles): the length by which the displacement rows of
/// the stacked Jacobian are divided, chosen where its condition number is least.
struct CharacteristicLength {
  double length = 1.0;                           ///< m
  double condition = 0.0;                        ///< of the stacked normalised Jacobian at that length
  std::vector<std::pair<double, double>> curve;  ///< condition number against length, over 0.05 m to 20 m
};

/// Golden-section search on log L within 0.05 m to 20 m, started at the best point of `curve`.
CharacteristicLength characteristicLength(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange);

/// The condition number at any length, m.
double jacobianCondition(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange, double length);

/// Complete Pose equations of one load case (Dumas et al.; paper (39), read as J K^-1 J^T W with only the
/// displacement rows divided by L): the displacement of P_TCP and the small rotation of the flange, both from
/// the rigid motion of the reflectors between unloaded and loaded. Rows 0-2 in m, rows 3-5 in rad, not yet
/// normalised. Needs load_case.flange_unloaded and flange_loaded.
CaseEquations completePoseEquations(const LoadCase& load_case, const Eigen::Vector3d& tcp_in_flange,
                                    const JointVector& torque);

/// How the right-hand side of completePoseEquations follows small displacements of the case's reflectors, three columns
/// each in their order: the least-squares rigid motion, taken in the middle of the move.
/// `geometry`: in which the flange's poses were found.
Eigen::Matrix<double, 6, Eigen::Dynamic> poseByReflectors(const frames::LoadingGeometry& geometry,
                                                          const LoadCase& load_case,
                                                          const Eigen::Vector3d& tcp_in_flange);

/// Pose equations with the displacement rows divided by the characteristic length.
CaseEquations normalised(const CaseEquations& pose_equations, double characteristic_length);

/// All compliances at once from normalised equations; residuals are judged at P_TCP's displacement.
StiffnessEstimate completePose(const std::vector<CaseEquations>& pose_equations, double characteristic_length,
                               const robot::JointMask& unknown);

/// The normal equations of pose equations, displacements and rotations apart, so that any L is a sum of two.
struct PoseNormal {
  NormalEquations displacements, rotations;

  void add(const CaseEquations& pose_equations);
  PoseNormal& operator+=(const PoseNormal& other);
  NormalEquations at(double characteristic_length) const;
};

}  // namespace stiffscope::identification
