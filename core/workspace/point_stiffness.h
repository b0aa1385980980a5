#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/effects/elastic_arm.h"
#include "core/frames/arm_geometry.h"
#include "core/identification/estimate.h"

namespace stiffscope::workspace {

using compensation::DeflectingArm;

/// What a force meets in one direction: the point moves by `compliance` times the force, along it.
struct DirectionalCompliance {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, R0
  double compliance = 0.0;                              ///< m/N
  identification::CoverageInterval interval;            ///< at the stated coverage, m/N

  double stiffness() const { return 1.0 / compliance; }  ///< N/m
  /// 1/compliance over the interval; open above where that holds zero.
  identification::CoverageInterval stiffnessInterval() const;
};

/// What gives at P_TCP in one posture where a force acts there and the flange is free to turn. R0.
///
/// C_x = J diag(c) J^T (paper (6), translational block) holds the springs of the joints, of which those of unknown
/// stiffness count as rigid. `model` holds besides what the effects of the machine in the model add (bearings, links,
/// base), by half the difference of the deflections under the day's largest force (500 N where that is not known) and
/// its opposite along each axis: a secant, with K_c in it.
///
/// A joint of unknown stiffness makes C_x too small, but not in the directions that it does not move the point: there a
/// force does no work on it. Principal directions are therefore sought at right angles to what such joints move, and
/// there are fewer than three of them: softest first.
///
/// Intervals: each draw of the certainty moves a direction's compliance by sum_j (z_j x r . d)^2 (c_draw - c)_j and
/// what its effects' parameters do, to first order; the direction stays. Effects only give: what a day does not show of
/// them lies above the model in nearly all draws, and the arm that hides nothing stands at their end, as uncertain as
/// the fit. Intervals of `of_springs` therefore hold, beside the quantiles of the draws, k u to either side by the
/// variance of the fit; those of `of_model` by that of springs and named effects and the square of what 68 % of the
/// draws do not exceed. The latter hold the truth more often than the stated coverage (docs/validation.md).
struct PointStiffness {
  std::string pose;  ///< of the campaign; empty: of none
  JointVector q;
  Eigen::Vector3d tcp = Eigen::Vector3d::Zero();
  double conditioning = 0.0;  ///< least over largest singular value of J at P_TCP, lengths over 1 m
  std::vector<int> unknown;   ///< joints (from 0) of unknown stiffness that move P_TCP
  Eigen::Matrix3d springs = Eigen::Matrix3d::Zero();  ///< m/N
  Eigen::Matrix3d model = Eigen::Matrix3d::Zero();    ///< m/N; as `springs` where the model has no more
  std::vector<DirectionalCompliance> of_springs;      ///< C_x alone, by what the day leaves open of the springs
  std::vector<DirectionalCompliance> of_model;
};

/// At the joint angles `q`, by an arm whose certainty is there. Empty where the arm does not come to rest there.
std::optional<PointStiffness> pointStiffness(const DeflectingArm& arm, const JointVector& q);

/// Whether a joint's stiffness is of use: found by the day or known from elsewhere, and not negative.
bool hasUsableStiffness(const identification::StiffnessEstimate& estimate, int joint);

}  // namespace stiffscope::workspace
