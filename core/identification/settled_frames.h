#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// Frames from which the own weight's sag is taken off, and the loaded arm in them.
struct SettledFrames {
  Frames frames;
  LoadedArm arm;                      ///< in the swept geometry
  std::vector<std::string> left_out;  ///< postures that cannot be used, with the reason
};

/// The own weight needs stiffnesses to be taken off the sweeps, and the stiffnesses need the sweeps: the two
/// are found in turns, from the rigid arm on; three rounds settle to 1e-4 of a stiffness. Without known
/// masses, the rigid arm's frames.
SettledFrames settleFrames(const Campaign& campaign, const std::vector<int>& steps, const IdentifyOptions& options);

/// The springs that the own weight bends, from the loads: by the decoupled method where P_wrist is measured, else
/// Partial Pose; no compliance negative. The covariance is from the scatter between postures.
StiffnessEstimate sagStiffness(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm);

/// The compliances of sagStiffness.
Vector6d sagCompliance(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm);

/// Rounds in which sag and stiffnesses are found in turns.
inline constexpr int kSagRounds = 3;

/// The loaded arm of the heaviest step where the campaign has what it takes; else the frames alone.
struct SettledDay {
  std::optional<int> step;
  Frames frames;
  LoadedArm arm;  ///< in the swept geometry; no cases without loads
};
SettledDay settleDay(const Campaign& campaign);

}  // namespace stiffscope
