#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/nominal_fit.h"
#include "core/mistakes/readings_of_day.h"
#include "core/mistakes/suspected.h"

namespace stiffscope::mistakes {

/// One change of the files by which the unloaded readings become those of the URDF's arm.
struct ArmCure {
  Suspected suspected;
  int things = 1;
  double rms = 0.0;         ///< with it, m
  std::optional<int> pose;  ///< the posture, or -1 the sweep, in which alone it is
  ReadingsOfDay day;        ///< with it
  NominalFit fit;           ///< of that
};

/// What the unloaded readings say of the URDF's arm, and what would mend them where they contradict it.
struct ArmSearch {
  NominalFit fit;              ///< as read
  bool contradicts = false;    ///< by more than any machine is off its drawing: half of the groups by kMissedGeometry
  std::vector<ArmCure> cures;  ///< that mend as well as each other, the simplest first
};

/// Tries the table of mistakes (arm_mistakes.h) in all tables, in some of them, at one posture or sweep; then pairs of
/// them; then a joint's zero, a link of the URDF and the scale, which have a size of their own. Nothing is tried where
/// the readings are within kSuspicious of the arm. A cure has to bring them to a quarter of what they miss it by.
ArmSearch searchArm(const campaign::Campaign& campaign, const ReadingsOfDay& day);

/// Readings nearer than that to the URDF's arm are not searched, m: heavy arms without known masses sag by more, and
/// then no cure is found; errors of geometry of a calibrated day are a tenth of it.
inline constexpr double kSuspicious = 5e-3;

}  // namespace stiffscope::mistakes
