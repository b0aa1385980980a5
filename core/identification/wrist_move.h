#pragma once

#include <optional>
#include <vector>

#include "core/identification/equations.h"

namespace stiffscope {

/// P_wrist in one load case, unloaded and loaded, by trilateration from three reflectors; R0, m.
struct WristMove {
  Eigen::Vector3d unloaded = Eigen::Vector3d::Zero();
  Eigen::Vector3d loaded = Eigen::Vector3d::Zero();

  Eigen::Vector3d displacement() const { return loaded - unloaded; }
};

/// Where the arm's model has P_wrist unloaded; `centre_at_zero`: at joints zero, a point of body 3.
Eigen::Vector3d modelledWrist(const Robot& arm, const LoadCase& load_case,
                              const Eigen::Vector3d& centre_at_zero);

/// (13)-(20) with the radii of the wrist sweep (`radii` by target, NaN where unknown), on the three
/// reflectors of the case that span the largest triangle; of the two roots the one nearer to `modelled`
/// (modelledWrist). Empty with fewer than three reflectors of known radius, or in one line.
std::optional<WristMove> wristMove(const LoadCase& load_case, const std::vector<double>& radii,
                                   const Eigen::Vector3d& modelled);

/// The equations of P_wrist's displacement. Columns 4-6 are nearly zero: the wrist's axes meet there.
CaseEquations wristEquations(const LoadCase& load_case, const WristMove& wrist, const Vector6d& torque);

}  // namespace stiffscope
