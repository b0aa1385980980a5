#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/identification/identification.h"
#include "core/identification/identify.h"
#include "core/robot/cartesian_stiffness.h"
#include "core/robot/kinematics.h"

namespace stiffscope::identification {

/// How well conditioned the arm is in one posture: what Dumas et al. (paper, [9]) choose postures by, so that
/// K_c may be neglected and identification not run into a singularity.
struct PostureConditioning {
  double kappa = 0.0;      ///< Frobenius, 1/m sqrt(tr(J_N^T J_N) tr((J_N^T J_N)^-1)) of its m = 6 singular
                           ///< values (as many as joints, of fewer); 1 is isotropic
  double kappa_two = 0.0;  ///< 2-norm: largest over least singular value of J_N
  double dexterity = 0.0;  ///< 1 / kappa, 0 to 1; 0 in a singularity
};

/// Of J_N = diag(1/L I, I) J, paper (8) with J (docs/method.md, Slips of the paper), J the Jacobian of a point of the
/// flange body. `length` is the characteristic length L, m. Infinite kappas in a singularity.
PostureConditioning postureConditioning(const Jacobian& jacobian, double length);

/// The arm's Cartesian stiffness at P_TCP in one posture and under one load, in R0.
struct PostureStiffness {
  std::string pose;
  PostureConditioning conditioning;      ///< at P_TCP, by the characteristic length given
  robot::CartesianStiffness without_kc;  ///< paper (6)
  robot::CartesianStiffness with_kc;     ///< paper (4), K_c of the load and of the own weight
  double kc_share = 0.0;                 ///< geometricStiffnessShare of the two
  std::vector<int> rigid_joints;         ///< from 0: not identifiable, taken as rigid, so that stiffnesses are too high
};

/// One posture: the arm at the joint angles of `posture` under `wrench` (R0), its point `tcp_in_flange`.
PostureStiffness postureStiffness(const frames::LoadingGeometry& geometry, const StiffnessEstimate& estimate,
                                  const robot::ArmPosture& posture, const robot::Wrench& wrench,
                                  const Eigen::Vector3d& tcp_in_flange, double length);

/// The load cases of an identified campaign by one method, each under its measured load; L is the campaign's
/// characteristic length, by the arm's model where Complete Pose has no flange poses to find it from. Refers to both.
/// One posture takes 1.5 kB, so it is computed when asked for.
class PostureStiffnesses {
 public:
  PostureStiffnesses(const campaign::Campaign& campaign, const Identification& result, Method method);

  std::size_t size() const { return size_; }  ///< 0 where the method is unavailable
  PostureStiffness at(std::size_t load_case) const;

 private:
  const campaign::Campaign& campaign_;
  const Identification& result_;
  const MethodResult& solved_;
  std::size_t size_;
  double length_ = 0.0;  ///< m
};

/// The postures that were used: with all load steps together a posture has several load cases.
std::size_t postureCount(const Identification& result);

}  // namespace stiffscope::identification
