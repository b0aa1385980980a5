#pragma once

#include <optional>
#include <vector>

#include "core/identification/warnings.h"
#include "core/mistakes/nominal_fit.h"
#include "core/mistakes/readings_of_day.h"
#include "core/mistakes/suspected.h"

namespace stiffscope::mistakes {

/// Readings nearer than that to the URDF's arm are not searched, m: heavy arms without known masses sag by more, and
/// then no cure is found; errors of geometry of a calibrated day are a tenth of it.
inline constexpr double kSuspicious = 5e-3;

/// From where on a search looks, m. Readings of a tracker carry what a machine is off its drawing; figures that a
/// controller computes do not.
struct SearchLimits {
  double suspicious = kSuspicious;                             ///< misfit below which nothing is looked for
  double least_shift = 0.5 * identification::kMissedGeometry;  ///< of a joint's origin in the URDF
};

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

}  // namespace stiffscope::mistakes
