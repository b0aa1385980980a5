#pragma once

#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// One posture that both campaigns measured.
struct AvoidedAtPosture {
  std::string pose;
  double before = 0.0;  ///< |displacement|, double encoders inactive, m
  double after = 0.0;   ///< the same, active
};

/// What active double encoders keep away of the deflection: 1 - sum |after| / sum |before| over common
/// postures.
struct AvoidedDeflection {
  bool available = false;
  std::string reason;
  bool at_wrist = false;  ///< at P_wrist; else at the reflectors (means)
  double share = 0.0;
  std::vector<AvoidedAtPosture> postures;
};

/// Postures are common where the pose id is the same, the joint angles agree within 0.01 deg and the forces
/// within 2 %. Unavailable, with the reason, where none is.
AvoidedDeflection avoidedDeflection(const Campaign& before_campaign, const Identification& before,
                                    const Campaign& after_campaign, const Identification& after);

}  // namespace stiffscope
