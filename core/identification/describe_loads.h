#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// What the loads did, whatever the method: load cases, displacements of P_wrist and of the reflectors,
/// change of the reported angles, the noise's share, and that of K_c at the compliances of the best method
/// there is. `shown`: the arm in the swept geometry, else in the calibrated one.
void describeLoads(const Campaign& campaign, LoadedArm shown, Identification& result);

/// Root mean square change of the joint torques by K_c at these compliances, relative to J_w^T W.
double geometricStiffnessShare(const LoadedArm& arm, const Vector6d& compliance);

}  // namespace stiffscope
