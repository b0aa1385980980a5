#pragma once

#include <array>
#include <string>

#include "core/comparison/matched_postures.h"

namespace stiffscope {

/// One joint's stiffness in both campaigns.
struct JointChange {
  bool comparable = false;
  std::string reason;  ///< why not: which campaign does not identify it, and why
  double before = 0.0,
         before_sd = 0.0;  ///< k and its standard uncertainty, Nm/rad; sd not a number: none stated
  double after = 0.0, after_sd = 0.0;
  double ratio = 0.0;        ///< after / before
  double ratio_sd = 0.0;     ///< to first order, correlation included
  double correlation = 0.0;  ///< of the two errors, by the postures that both share
  double p_value = 0.0;      ///< two-sided, of no change; not a number where an uncertainty is
  std::string mark;          ///< of either entry: "negative" or "imprecise"; else empty
};

struct StiffnessChange {
  bool available = false;
  std::string reason;
  std::array<JointChange, 6> joints;
};

/// Compares by one method. The test is on compliances, whose errors are nearly normal where those of k = 1/c
/// are heavy-tailed: t = (c_a - c_b) / sqrt(u_b^2 + u_a^2 - 2 r u_b u_a), u the stated standard
/// uncertainties, against Student's distribution with the degrees of freedom of the smaller campaign
/// (postures less a third of the unknowns, a posture giving three coordinates). What the model misses recurs
/// in a posture that is measured twice, so the errors are correlated: r = sum over pairs d_b d_a / sqrt(sum
/// d_b^2 sum d_a^2), d how leaving out a posture moves c (moveByEachPosture).
StiffnessChange compareStiffness(const Identification& before, const Identification& after, Method method,
                                 const MatchedPostures& matched);

}  // namespace stiffscope
