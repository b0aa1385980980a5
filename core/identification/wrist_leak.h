#pragma once

#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// Share of P_wrist's displacement that joints 4-6 may put there, because the wrist's axes miss each other,
/// before decoupling is refused: it takes that displacement for one of joints 1-3, so this is the error it
/// then carries into c1..c3.
inline constexpr double kWristLeakBorne = 0.02;

/// Share of P_wrist's displacement, over the load cases, that turning in joints 4-6 puts there: sum of
/// |J_m c tau| with c1..c3 zero over sum of |displacement|. 0 for a wrist whose axes meet; also where P_wrist
/// is not measured. `centre_at_zero`: P_wrist at joints zero, R0, m; `compliance` in rad/Nm. The arm's
/// torques are those of its last solution.
double wristLeak(const LoadedArm& arm, const Eigen::Vector3d& centre_at_zero, const Vector6d& compliance);

}  // namespace stiffscope
