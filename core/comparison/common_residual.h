#pragma once

#include <optional>

#include "core/comparison/matched_postures.h"
#include "core/identification/identification.h"

namespace stiffscope::comparison {

/// What joint springs leave of the reflectors' displacements in both states, b - A c, all joints together by least
/// squares (per coordinate, over degrees of freedom, m), and whether it is noise.
struct CommonResidual {
  bool available = false;
  double before = 0.0, after = 0.0;
  std::optional<double> noise_before, noise_after;  ///< of the tracker; empty where not declared
  // Where postures correspond (six or more), by fits to these; else not numbers:
  double of_difference = 0.0;  ///< of what after leaves less what before leaves
  double correlation = 0.0;    ///< of the two
  /// p-value of no misfit in common: one-sided, Student's t of the postures' products r_b . r_a, whose mean is zero
  /// where both are noise.
  double recurs_p = 0.0;

  /// Nothing in common (5 %), and in neither state above three times the tracker's noise. Without postures that
  /// correspond: in neither above 1.3 times the declared noise. What does not show in residuals because a change of
  /// compliances does the same is not seen.
  bool isNoise() const;
  /// What changed is more than compliances of joints and noise: the difference's residual is above three times the
  /// tracker's noise in it.
  bool differenceAboveNoise() const;
};

/// By Partial Pose's equations where both states have them, else Complete Pose's or the decoupled method's.
CommonResidual commonResidual(const campaign::Campaign& before_campaign, const identification::Identification& before,
                              const campaign::Campaign& after_campaign, const identification::Identification& after,
                              const MatchedPostures& matched);

}  // namespace stiffscope::comparison
