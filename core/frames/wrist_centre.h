#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/base_frame.h"
#include "core/frames/gravity_sag.h"
#include "metrology/remark.h"
#include "metrology/sphere_fit.h"

namespace stiffscope::frames {

/// One row of the paper's Table I.
struct WristTableRow {
  int target = 0;
  Eigen::Vector3d centre_in_r0 = Eigen::Vector3d::Zero();  ///< of the sphere of this reflector's own sweep, m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of the centre, by its own readings; R0 axes, m^2
  double radius = 0.0;                                     ///< m
  double offset = 0.0;                                     ///< distance of this centre from the mean of the centres, m
  double rms = 0.0;                                        ///< radial residuals of this reflector's sphere, m
  int readings = 0;
};

/// The wrist centre by the wrist sweep (paper, II.D).
struct WristCentre {
  bool measured = false;
  Remark reason;
  Vector6d q = Vector6d::Zero();                           ///< axes 1-3 during the sweep (4-6 zero)
  Eigen::Vector3d centre_in_r0 = Eigen::Vector3d::Zero();  ///< common centre of all spheres, at q
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of it, with R0's (FramesCovariance); R0 axes, m^2
  Eigen::Vector3d centre_at_zero_in_r0 = Eigen::Vector3d::Zero();  ///< with axes 1-3 turned back to zero
  std::vector<double> radii;  ///< |P_wrist P1X| by target; NaN for a target that was not swept
  metrology::SphereFit
      spheres;               ///< in R0 as it is measured: its covariance is that of the wrist sweep's readings alone
  std::vector<int> targets;  ///< of the spheres
  std::vector<WristTableRow> table;  ///< Table I
  Eigen::Vector3d table_mean_in_r0 = Eigen::Vector3d::Zero();
  /// Of the mean: the rows' readings are independent of each other, R0 is common to them. R0 axes, m^2.
  Eigen::Matrix3d table_mean_covariance = Eigen::Matrix3d::Zero();

  // Side by side with the sphere centre, all at q (method: Wrist centre).
  Eigen::Vector3d reflector_barycentre_in_r0 = Eigen::Vector3d::Zero();  ///< Dumas et al.
  Eigen::Vector3d nearest_axes_56_in_r0 = Eigen::Vector3d::Zero();       ///< middle of their common perpendicular
  double miss_45 = 0.0;                                                  ///< distance between axes 4 and 5, m
  double miss_56 = 0.0;                                                  ///< distance between axes 5 and 6, m
  double miss_45_sd = 0.0;  ///< standard uncertainty (FramesCovariance); 0 where the axes were not measured
  double miss_56_sd = 0.0;
};

/// Fits concentric spheres to the wrist sweep, on the readings referred to the rigid arm.
/// Not measured, with the reason, without a sweep, without R0 in the sweep's frame, or where the fit is undetermined.
WristCentre measureWristCentre(const campaign::Campaign& campaign, const ArmInR0& arm, const RigidPoints& points,
                               const std::vector<std::optional<Eigen::Vector3d>>& targets_at_zero);

}  // namespace stiffscope::frames
