#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/audit/position_fit.h"
#include "core/campaign/state_points.h"
#include "core/identification/loaded_arm.h"
#include "core/preparation/prepare.h"

namespace stiffscope::audit {

/// What the checks look at: the campaign as identification sees it.
struct AuditInput {
  campaign::Campaign campaign;         ///< without rejected readings, drift taken off where nests explain it
  preparation::DriftCorrection drift;  ///< how far it was
  preparation::StationMotion station;  ///< by the nests
  preparation::RepeatScatter scatter;  ///< of the repeats, against the declared noise
  /// Declared, or as the repeats show it where that is larger; `campaign.tracker` says the same.
  std::optional<metrology::TrackerNoise> noise;
  std::vector<campaign::StatePoints> states;  ///< reflectors in every state of sweeps and loading
  std::optional<int> step;                    ///< heaviest load step
  frames::Frames frames;                      ///< sag taken off where it can be
  frames::RigidPoints rigid;                  ///< the sweeps' readings, sag taken off where it can be
  identification::LoadedArm arm;              ///< in the swept geometry, under `step`; no cases where there are none
  AbsoluteFit absolute;                       ///< unloaded positions against forward kinematics
};

/// Of a campaign and of what else its preparation found.
AuditInput auditInput(campaign::Campaign campaign, const preparation::PreparedCampaign& found);

}  // namespace stiffscope::audit
