#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/finding.h"
#include "metrology/remark.h"

namespace stiffscope::preparation {

/// Readings of floor nests that stand apart from their nest's other readings, whatever the station did.
struct NestOutliers {
  bool tested = false;
  Remark reason;                          ///< why not
  std::vector<RejectedReading> readings;  ///< in the order of the table
  int rounds = 0;
  int rounds_of_three = 0;  ///< rounds of three nests or fewer, in which not every wrong reading can be told
};

/// A round's nests keep their shape, however the station moved. Two steps, both at the level of the audit shared by the
/// readings, times the nests' own median scatter where that is larger than declared:
///
/// 1. Distances between two nests against their median over the rounds. The nest that most distances of its round
///    speak against, two or more, is wrong there. Medians and majorities hold whatever size the errors have.
/// 2. One after the other, worst first, readings that stand apart from places and motions fitted to all that are left:
///    v^T Q_v^-1 v, v a reading's residual and Q_v its covariance, is chi-square with as many degrees of freedom as Q_v
///    has directions that the motion leaves open (Baarda, A testing procedure for use in geodetic networks, 1968).
///    Where others of the round mend it as well when left out, nobody can tell which is wrong, and all of them go.
///
/// Readings of one nest that stand apart together - two in a row where the day begins or ends, three anywhere - are a
/// nest that was moved, which core/preparation/drift_nests.h judges: they stay. So do more than one in twenty, and more
/// than three, by the second step: they are no single readings.
///
/// Of five nests an error across their plane leaves one or two in doubt and enough for the motion; four show only that
/// there is one, and the round is lost; three show it in their plane alone; of two none is known to be wrong. Not
/// tested: no nests, no declared noise, fewer than three rounds or three nests.
NestOutliers nestOutliers(const campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
