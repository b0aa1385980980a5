#pragma once

#include <optional>

#include "core/calibration/calibrate.h"
#include "core/campaign/campaign.h"

namespace stiffscope::calibration {

/// The state of the arm from which a fitted growth of its lengths is counted, as is that of the axes fitted with it.
struct GrowthFrom {
  std::optional<double> temperature_c;  ///< by temperature: the mean over the day's postures
  bool first_posture = false;           ///< by time: the arm as it was in the first posture

  bool any() const { return temperature_c.has_value() || first_posture; }
};

/// Of the fullest model; nothing where it has no growth. `campaign`: whose day was calibrated.
GrowthFrom growthFrom(const campaign::Campaign& campaign, const Calibration& calibration);

}  // namespace stiffscope::calibration
