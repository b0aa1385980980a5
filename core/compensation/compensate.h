#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/compensation/elastic_arm.h"
#include "core/identification/stiffness_estimate.h"

namespace stiffscope {

/// A posture and the load-cell reading expected there (as in the `states` table).
struct PostureToCompensate {
  std::string id;
  Vector6d q = Vector6d::Zero();               ///< rad
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< N, Nm, in the load cell's axes
};

/// Predicted deflection of P_TCP by the load, and the joint commands that cancel it.
struct CompensatedPosture {
  PostureToCompensate posture;
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();   ///< of P_TCP, R0, m: loaded less unloaded
  Eigen::Vector3d deflection_sd = Eigen::Vector3d::Zero();  ///< from the stiffnesses' covariance, m
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< of the flange, rotation vector in R0, rad
  bool solved = false;
  std::string reason;                   ///< why there are no commands
  Vector6d commands = Vector6d::Zero(); ///< joint angles to command, rad
  double remaining = 0.0;               ///< |P_TCP(loaded, commands) - P_TCP(unloaded, q)| in the model, m
  double conditioning = 0.0;            ///< least over largest singular value of J at P_TCP, lengths over 1 m
};

struct CompensateOptions {
  double least_conditioning = 0.01;  ///< below it a posture is too near a singularity
  double share_unknown = 0.02;       ///< of the largest joint torque: what may turn a joint of unknown stiffness
};

/// For each posture: the nonlinear model (finite rotations, own weight and load on the moved arm) gives the loaded
/// pose; Newton steps on the commands bring the loaded flange back onto the pose that the unloaded arm has at q. The wrench is taken
/// into R0 at the unloaded flange and keeps its direction. No commands, with the reason, near a singularity, where a
/// command leaves the joint limits, or where the steps do not converge, or where the load turns a joint whose stiffness is not known by more
/// than `trusted_torque`.
std::vector<CompensatedPosture> compensate(const Campaign& campaign, const LoadingGeometry& geometry,
                                           const StiffnessEstimate& estimate, const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options = {});

}  // namespace stiffscope
