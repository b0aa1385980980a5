#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/equations.h"
#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// A posture whose displacements disagree with what the others' springs say.
struct OutlyingPosture {
  int posture = 0;       ///< CaseEquations::posture
  double rms = 0.0;      ///< its residual against the fit to the others, per coordinate, m
  double others = 0.0;   ///< that of the others, each against the fit that leaves this one out, m
  double f = 0.0;        ///< ratio of the studentised mean squares
  double p_value = 1.0;  ///< of it, times the number of postures (Bonferroni)
};

/// Leave-one-posture-out: Q_p = e^T (I - H_p) e, e = b_p - A_p c(without p), against the mean of the others' Q in the
/// fit without p, an F ratio. Coordinates of a posture are not independent (a wrench error moves all of them), so a Q
/// counts for tr(S)^2 / tr(S^2) degrees of freedom only, S the residuals' second moments over the postures. The worst
/// is taken away first and the rest judged again, down to half of the postures. Several that err alike hide each other
/// from that: those far from a robust fit are then judged by the fit to the rest without them, and named where they, up
/// to a quarter of the postures, are three times as far off as any other. `unknown`: joints solved for. Equations: one
/// a posture, positions. Empty with fewer than five postures. A posture counts as outlying at 0.1 %, all postures
/// together.
std::vector<OutlyingPosture> outlyingPostures(const std::vector<CaseEquations>& equations,
                                              const robot::JointMask& unknown);

/// Takes away the load states and readings of the postures marked, by pose; their ids keep their places.
void dropPostures(const std::vector<bool>& dropped, campaign::Campaign& campaign);

/// The campaign without the load states and readings of these postures; their ids keep their places.
campaign::Campaign withoutPostures(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& postures);

/// Replaces what `left_out` says of these postures by why they are left out.
void nameLeftOut(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& postures,
                 std::vector<LeftOutPosture>& left_out);

}  // namespace stiffscope::identification
