#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/gravity_sag.h"
#include "metrology/lines.h"
#include "metrology/remark.h"

namespace stiffscope::frames {

/// All axes of an arm with coupled joints, in the frame of the sweeps' readings, all joints at zero.
struct CoupledAxes {
  Remark reason;                                 ///< why not found; empty: found
  std::vector<metrology::MeasuredLine> at_zero;  ///< one an axis, directed as it turns positively
  double rms = 0.0;                              ///< of the readings, plain, per coordinate, m
  double chi2_per_dof = 0.0;                     ///< weighted; 1 where no tracker is declared
};

/// Where a joint turns several axes the reflectors move on circles without a common axis, and no sweep shows an axis by
/// itself. All sweeps together do: ArmParameters of the whole arm by least squares on every reading of the circle and
/// wrist sweeps, on the readings referred to the rigid arm, weighted by the tracker's covariance where it is declared;
/// Gauss-Newton from the URDF's arm, placed by the postures (baseFromPostures).
/// Priors: each axis within 10 mm and 10 mrad of the URDF, which only counts for what the sweeps do not see; axes that
/// are one line in the URDF (a parallelogram's elbow, about which one joint turns the forearm and another keeps it
/// level) are one hinge of the machine and stay one line: without that no motion of the flange shows where axis 2
/// stands. Covariance of each line: by the inverse normal matrix, times chi^2 over degrees of freedom where that is
/// above one; what the lines have in common is not kept. Not found, with the reason: without sweeps, without three
/// reflectors in three postures, where the flange turns about one direction only (its reflectors then show offsets of
/// axes and of themselves in sum, and what tells them apart is the sag), or where the steps do not settle.
CoupledAxes fitCoupledAxes(const campaign::Campaign& campaign, const RigidPoints& points);

}  // namespace stiffscope::frames
