#pragma once

#include "core/simulation/machine_spec.h"
#include "core/simulation/torque_curve.h"

namespace stiffscope::simulation {

/// What the joint's torsion has besides a linear spring; where it has stages or a gap, all of it: half of the
/// gap to each side with `rest` of the first rate, then the stages (or the one rate), shifted by that half.
TorqueCurve jointCurve(const JointStiffness& joint);

/// What the base gets where its crack has closed.
TorqueCurve contactCurve(const OneSidedContact& contact);

}  // namespace stiffscope::simulation
