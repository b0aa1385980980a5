#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/cartesian_stiffness/cartesian_stiffness.h"
#include "core/cartesian_stiffness/posture_conditioning.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// The arm's Cartesian stiffness at P_TCP in one posture and under one load, in R0.
struct PostureStiffness {
  std::string pose;
  PostureConditioning conditioning;  ///< at P_TCP, by the characteristic length given
  CartesianStiffness without_kc;     ///< paper (6)
  CartesianStiffness with_kc;        ///< paper (4), K_c of the load and of the own weight
  double kc_share = 0.0;             ///< geometricStiffnessShare of the two
  std::vector<int>
      rigid_joints;  ///< 0..5: not identifiable, taken as rigid, so that stiffnesses are too high
};

/// One posture: the arm at the joint angles of `posture` under `wrench` (R0), its point `tcp_in_flange`.
PostureStiffness postureStiffness(const LoadingGeometry& geometry, const StiffnessEstimate& estimate,
                                  const ArmPosture& posture, const Wrench& wrench,
                                  const Eigen::Vector3d& tcp_in_flange, double length);

/// The load cases of an identified campaign by one method, each under its measured load; L is the campaign's
/// characteristic length, by the arm's model where Complete Pose has no flange poses to find it from. Refers to both. One
/// posture takes 1.5 kB, so it is computed when asked for.
class PostureStiffnesses {
 public:
  PostureStiffnesses(const Campaign& campaign, const Identification& result, Method method);

  std::size_t size() const { return size_; }  ///< 0 where the method is unavailable
  PostureStiffness at(std::size_t load_case) const;

 private:
  const Campaign& campaign_;
  const Identification& result_;
  const MethodResult& solved_;
  std::size_t size_;
  double length_ = 0.0;  ///< m
};

}  // namespace stiffscope
