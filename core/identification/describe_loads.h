#pragma once

#include "core/identification/identify.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// What the loads did, whatever the method: load cases, displacements of P_wrist and of the reflectors,
/// change of the reported angles, the noise's share, and that of K_c at the compliances of the best method
/// there is. `shown`: the arm in the swept geometry, else in the calibrated one.
void describeLoads(const Campaign& campaign, const LoadedArm& shown, Identification& result);

}  // namespace stiffscope
