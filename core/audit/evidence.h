#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/audit/absolute_fit.h"
#include "core/audit/state_points.h"
#include "core/audit/station_motion.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// What the checks look at: readings screened, the station's drift taken off where nests explain it.
struct Evidence {
  const Campaign& original;           ///< as it was read
  Campaign campaign;                  ///< without rejected readings, drift taken off
  std::optional<TrackerNoise> noise;  ///< declared
  StationMotion station;              ///< by the nests
  std::vector<StatePoints> states;    ///< reflectors in every state of sweeps and loading
  std::optional<int> step;            ///< heaviest load step
  Frames frames;                      ///< sag taken off where it can be
  RigidPoints rigid;                  ///< the sweeps' readings, sag taken off where it can be
  LoadedArm arm;                      ///< in the swept geometry, under `step`; no cases where there are none
  AbsoluteFit absolute;               ///< unloaded positions against forward kinematics
};

Evidence gatherEvidence(const Campaign& original, const Campaign& screened);

}  // namespace stiffscope
