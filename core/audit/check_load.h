#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "metrology/remark.h"

namespace stiffscope::audit {

/// A load that hangs or pulls at one point of the tool: M = lever x F with one lever, in the load cell's
/// axes.
struct LoadPointFit {
  bool done = false;
  Remark reason;                                    ///< why not
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< from the cell's point to the load's, in the tool, m
  double chi2 = 0.0;
  int dof = 0;
  double rms = 0.0;         ///< of the moments' residuals, per component, Nm
  double worst_chi2 = 0.0;  ///< of one state, three components
  double worst_limit = 0.0;
  std::size_t worst_line = 0;  ///< in the states' file
  int worst_pose = 0;
  int worst_step = 0;
  /// Components of the moment whose turned sign mends the fit; empty: none does.
  std::vector<std::string> mending_signs;
  bool mends_all_states = false;  ///< turned in all states, not in the worst alone
};

/// Weighted least squares over all states with a force; the moment's variance is that of the moment and of
/// the lever times the force's. Axes that do not turn with the flange are turned into it by forward
/// kinematics of the URDF. Not done, with the reason: moments that were not measured, or forces along one
/// line in the tool, which leave the lever open.
LoadPointFit fitLoadPoint(const campaign::Campaign& campaign);

}  // namespace stiffscope::audit
