#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/finding.h"

namespace stiffscope::preparation {

/// A campaign without the readings that should not be used, and the checks that found them.
struct Screening {
  campaign::Campaign campaign;
  std::vector<RejectedReading> rejected;
  std::vector<AuditCheck> checks;  ///< lost_beam, duplicate_readings, repeat_outliers, nest_outliers
};

/// Takes out, one kind after the other: points at exactly (0, 0, 0), which a tracker writes when it has lost
/// its beam; points that repeat another's coordinates to the last digit, which is the other reading copied or
/// the beam still on the other reflector; repeats of one state that stand apart from the others by more
/// than noise; and single readings of floor nests that the other nests contradict (core/preparation/nest_outliers.h).
Screening screenReadings(campaign::Campaign campaign);

}  // namespace stiffscope::preparation
