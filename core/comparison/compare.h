#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/comparison/deflection_avoided.h"
#include "core/comparison/matched_postures.h"
#include "core/comparison/remarks.h"
#include "core/identification/identify.h"
#include "metrology/remark.h"

namespace stiffscope::comparison {

/// One joint's stiffness in both campaigns.
struct JointChange {
  bool comparable = false;
  Remark reason;  ///< why not: which campaign does not identify it, and why
  double before = 0.0,
         before_sd = 0.0;  ///< k and its standard uncertainty, Nm/rad; sd not a number: none stated
  double after = 0.0, after_sd = 0.0;
  double ratio = 0.0;        ///< after / before
  double ratio_sd = 0.0;     ///< to first order, correlation included
  double correlation = 0.0;  ///< of the two errors, by the postures that both share
  double p_value = 0.0;      ///< two-sided, of no change; not a number where an uncertainty is
  Remark mark;               ///< of either entry: negative or imprecise; else empty
};

struct StiffnessChange {
  bool available = false;
  Remark reason;
  std::array<JointChange, 6> joints;
};

/// Compares by one method. The test is on compliances, whose errors are nearly normal where those of k = 1/c
/// are heavy-tailed: t = (c_a - c_b) / sqrt(u_b^2 + u_a^2 - 2 r u_b u_a), u the stated standard
/// uncertainties, against Student's distribution with the degrees of freedom of the smaller campaign
/// (postures less a third of the unknowns, a posture giving three coordinates). What the model misses recurs
/// in a posture that is measured twice, so the errors are correlated: r = sum over pairs d_b d_a / sqrt(sum
/// d_b^2 sum d_a^2), d how leaving out a posture moves c (moveByEachPosture).
StiffnessChange compareStiffness(const identification::Identification& before,
                                 const identification::Identification& after, identification::Method method,
                                 const MatchedPostures& matched);

/// Two campaigns of one machine side by side: double encoders inactive and active, or before and after a
/// repair.
struct Comparison {
  bool comparable = false;       ///< some stiffness or some deflection is
  Remark reason;                 ///< why nothing is
  std::vector<Remark> cautions;  ///< what a reader must know before believing the numbers
  MatchedPostures matched;
  std::array<StiffnessChange, 3> methods;  ///< by Method
  DeflectionAvoided at_wrist, at_targets;

  const StiffnessChange& of(identification::Method method) const { return methods[static_cast<std::size_t>(method)]; }
  /// The deflection avoided at P_wrist where it is measured, else at the reflectors.
  bool judgedAtWrist() const { return at_wrist.available; }
  const DeflectionAvoided& avoided() const { return at_wrist.available ? at_wrist : at_targets; }
  /// The decoupled method where it can be had, else Partial Pose, else Complete Pose.
  identification::Method best() const;
};

/// Never throws for what the data lacks: what cannot be compared says why.
Comparison compareCampaigns(const campaign::Campaign& before_campaign, const identification::Identification& before,
                            const campaign::Campaign& after_campaign, const identification::Identification& after,
                            const BootstrapOptions& options = {});

/// By how much each posture moves a method's compliances: the estimate from all postures less the estimate
/// without it, one vector a load case, rad/Nm (the jackknife's differences; B. Efron, The Jackknife, the
/// Bootstrap and Other Resampling Plans, 1982, chapter 3). The equations are those that `method` was solved
/// from last, so nothing is linearised but the finite deflection. Empty where the method is unavailable.
std::vector<Vector6d> moveByEachPosture(const identification::Identification& result, identification::Method method);

}  // namespace stiffscope::comparison
