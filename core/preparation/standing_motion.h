#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope::preparation {

/// Whether readings of a load state go on moving while its load stands, as a machine that creeps does.
///
/// With u the displacement of a reflector from the load step before to this one, and m how far its last repeat lies
/// from its first along u: m = b |u| + noise, b by least squares over all states, t = b / u(b), u(b) from the scatter
/// about that line, so that no noise has to be declared. Elastic deflection, friction and play depend on how a load
/// came, not on how long it stands: they give b = 0.
struct StandingMotion {
  int states = 0;      ///< reflectors' states with two repeats or more, the first load step of a posture left out
  double share = 0.0;  ///< b
  double rms = 0.0;    ///< of b |u|, m
  double t = 0.0;      ///< 0 where fewer than ten states say it
  double limit = 0.0;  ///< of |t|, Student's at the level of the audit (kLevel)

  bool significant() const { return states > 0 && t > limit && limit > 0.0; }
};

/// Of the readings of the loading, in the order of the table.
StandingMotion standingMotion(const campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
