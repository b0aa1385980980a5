#pragma once

#include "core/calibration/denavit_hartenberg.h"
#include "core/calibration/fitted_arm.h"

namespace stiffscope::reports {

/// Standard uncertainties of the link parameters of a fitted geometry, in the places of the parameters, m and rad: the
/// covariance of what was fitted, propagated to first order by differences. 0 where nothing that was fitted moves one.
PerJoint<calibration::LinkParameters> linkUncertainties(const calibration::ArmFit& fit, const robot::Robot& nominal);

}  // namespace stiffscope::reports
