#pragma once

#include <array>
#include <optional>

#include "core/campaign/campaign.h"
#include "core/identification/identify.h"

// What Ambiehl et al., IROS 2017 print, for the columns beside ours.

namespace stiffscope::reports {

struct PaperStiffness {
  double mean = 0.0, sd = 0.0;  ///< 10^6 Nm/rad
};

/// Table II; empty for joint 1 (0-based joint 0), which it does not have, where the state of the double encoders is not
/// declared, and beside a machine that has not six joints as the paper's.
std::optional<PaperStiffness> paperStiffness(const campaign::Campaign& campaign, identification::Method method,
                                             int joint);

/// IV.E: share of P_wrist's deflection compensated, from 10 postures judged on 19, double encoders active.
inline constexpr std::array<double, 3> kPaperCompensated{0.50, 0.80, 0.84};

/// IV.E: share of P_wrist's deflection that the double encoders avoid.
inline constexpr double kPaperAvoided = 0.40;

/// Table I: largest distance of a reflector's centre from the mean, mm.
inline constexpr double kPaperWristOffsetMm = 0.06;

}  // namespace stiffscope::reports
