#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// The plate between flange and reflectors gives: rotation about the flange origin about its three axes by
/// the moment there, shift along them by the force, in flange axes. Either of the load and of what hangs on
/// the flange, or of the load alone, where the tool's weight does not go through the plate. The turn about
/// axis 6 is joint 6's own compliance where both axes agree. rad/Nm and m/N, never negative.
EffectModel toolCompliance();
EffectModel toolComplianceByLoad();

}  // namespace stiffscope::effects
