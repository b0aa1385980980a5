#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// The unloaded arm at joint angles q (as reported, rad): sag of the joints' springs, and what the effects in
/// the model do under the own weight alone, each computed where the others have left the arm.
ArmState restState(const LoadingGeometry& geometry, const WorkingPoint& at, const Vector6d& q);

/// Joint angles by which the effects in the model turn the arm where it rests, rad.
Vector6d presentTurn(const WorkingPoint& at, const ArmState& rest);

}  // namespace stiffscope
