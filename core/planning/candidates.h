#pragma once

#include <cstdint>
#include <vector>

#include "core/planning/posture_rules.h"

namespace stiffscope {

/// A posture that keeps the rules, a load on it, and what measuring it would tell.
struct Candidate {
  Vector6d q = Vector6d::Zero();                        ///< rad
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< of the load, unit, R0
  LoadCase load_case;                                   ///< posture and wrench, R0; no readings
  /// Of the compliances c: sum over the reflectors of A^T S^-1 A, A = J_m diag(J_w^T W) as in paper (12), S
  /// the covariance of the reflector's displacement. (Nm/rad)^2.
  Matrix6d information = Matrix6d::Zero();
};

struct CandidateDraw {
  std::vector<Candidate> kept;
  std::array<int, kPostureRules> broken{};  ///< of the postures drawn, by the first rule broken
  int drawn = 0;
};

/// Uniform in the box, one load each: hanging along gravity, or a pull in one of nine directions
/// (horizontally along and against base_link's x and y, down, and half way between), drawn too. Stops at
/// `count` kept, or when 400 times as many were drawn. Throws InputError with the count of each rule broken
/// where not one keeps them all.
CandidateDraw drawCandidates(const PlanningArm& arm, const PostureRules& rules, int count,
                             std::uint64_t seed);

/// The same of a posture that is given.
Candidate candidateAt(const PlanningArm& arm, const Vector6d& q, const Eigen::Vector3d& direction);

/// Unit directions in R0 that a load may have.
std::vector<Eigen::Vector3d> loadDirections(const PlanningArm& arm);

/// Load-cell reading (N, Nm, in the cell's axes) that a candidate's load gives.
Vector6d expectedReading(const PlanningArm& arm, const Candidate& candidate);

}  // namespace stiffscope
