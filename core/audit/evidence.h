#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/audit/absolute_fit.h"
#include "core/audit/prepare.h"
#include "core/audit/state_points.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// What the checks look at: the campaign as identification sees it.
struct Evidence {
  Campaign campaign;      ///< without rejected readings, drift taken off where nests explain it
  DriftCorrection drift;  ///< how far it was
  StationMotion station;  ///< by the nests
  RepeatScatter scatter;  ///< of the repeats, against the declared noise
  /// Declared, or as the repeats show it where that is larger; `campaign.tracker` says the same.
  std::optional<TrackerNoise> noise;
  std::vector<StatePoints> states;  ///< reflectors in every state of sweeps and loading
  std::optional<int> step;          ///< heaviest load step
  Frames frames;                    ///< sag taken off where it can be
  RigidPoints rigid;                ///< the sweeps' readings, sag taken off where it can be
  LoadedArm arm;                    ///< in the swept geometry, under `step`; no cases where there are none
  AbsoluteFit absolute;             ///< unloaded positions against forward kinematics
};

/// Of a campaign and of what else its preparation found.
Evidence gatherEvidence(Campaign campaign, const PreparedCampaign& found);

}  // namespace stiffscope
