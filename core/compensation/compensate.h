#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/compensation/remarks.h"
#include "core/effects/elastic_arm.h"
#include "core/identification/estimate.h"
#include "metrology/remark.h"

namespace stiffscope::compensation {

/// A posture and the load-cell reading expected there (as in the `states` table).
struct PostureToCompensate {
  std::string id;
  Vector6d q = Vector6d::Zero();               ///< rad
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< N, Nm, in the load cell's axes
};

/// Predicted move of one point of the flange body by the load, loaded less unloaded, and its standard
/// uncertainty from the stiffnesses' covariance: R0 axes, m.
struct PointDeflection {
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();
};

/// Predicted deflection by the load, and the joint commands that cancel it.
struct CompensatedPosture {
  PostureToCompensate posture;
  bool predicted = false;  ///< false: the arm does not come to rest under this load, and nothing below is given
  PointDeflection tcp;     ///< of P_TCP
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< of the flange, rotation vector in R0, rad
  Eigen::Vector3d rotation_sd = Eigen::Vector3d::Zero();  ///< its standard uncertainty, rad
  std::vector<PointDeflection> targets;  ///< of the reflectors, in the order of the campaign's; empty: places not known
  bool solved = false;
  Remark reason;                         ///< why there are no commands
  Vector6d commands = Vector6d::Zero();  ///< joint angles to command, rad
  double mirrored_remaining = 0.0;       ///< |move of P_TCP| left where the predicted turn is subtracted once, m
  double remaining = 0.0;     ///< the same by the commands: |P_TCP(loaded, commands) - P_TCP(unloaded, q)|, m
  double conditioning = 0.0;  ///< least over largest singular value of J at P_TCP, lengths over 1 m
};

struct CompensateOptions {
  double least_conditioning = 0.01;  ///< below it a posture is too near a singularity
  double share_unknown = 0.02;       ///< of the largest joint torque: what may turn a joint of unusable stiffness
};

/// For each posture: the nonlinear model (finite rotations, own weight and load on the moved arm) gives the
/// loaded pose; Newton steps on the commands bring the loaded flange back onto the pose that the unloaded arm
/// has at q. The wrench is taken into R0 at the unloaded flange and keeps its direction. No commands, with
/// the reason, where the posture is outside the joint limits or a command would be, near a singularity, where
/// the steps do not converge, and where more than `share_unknown` of the largest joint torque turns a joint
/// whose stiffness is not known or came out negative. Uncertainties are first order, J diag(tau) U_c
/// diag(tau) J^T; not a number where U_c is not.
///
/// `with`: an arm that gives at more than its joint springs takes the place of these; its uncertainty adds in squares.
std::vector<CompensatedPosture> compensate(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                           const identification::StiffnessEstimate& estimate,
                                           const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options = {},
                                           const effects::EffectDeflection* with = nullptr);

/// A remark on each posture whose commands turn a joint by more than 2 deg against its angle: ten times
/// what a heavy load does to a weak joint, so that forces, moments or angles are rather in another unit.
std::vector<Remark> implausibleCommands(const std::vector<CompensatedPosture>& postures);

/// Reads postures and wrenches from a CSV file: `pose` (any name, not repeated), `q1_deg`..`q6_deg`, and the load-cell
/// reading expected there, `fx_n fy_n fz_n mx_nm my_nm mz_nm`; columns in any order. Throws InputError as the
/// campaign's tables do; unknown columns go to `warnings`.
std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The campaign's own postures in load step `step`.
std::vector<PostureToCompensate> campaignPostures(const campaign::Campaign& campaign, int step);

}  // namespace stiffscope::compensation
