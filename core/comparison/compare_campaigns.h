#pragma once

#include "core/comparison/compare_stiffness.h"
#include "core/comparison/deflection_avoided.h"

namespace stiffscope {

/// Two campaigns of one machine side by side: double encoders inactive and active, or before and after a
/// repair.
struct Comparison {
  bool comparable = false;            ///< some stiffness or some deflection is
  std::string reason;                 ///< why nothing is
  std::vector<std::string> cautions;  ///< what a reader must know before believing the numbers
  MatchedPostures matched;
  std::array<StiffnessChange, 3> methods;  ///< by Method
  DeflectionAvoided at_wrist, at_targets;

  const StiffnessChange& of(Method method) const { return methods[static_cast<std::size_t>(method)]; }
  /// The deflection avoided at P_wrist where it is measured, else at the reflectors.
  bool judgedAtWrist() const { return at_wrist.available; }
  const DeflectionAvoided& avoided() const { return at_wrist.available ? at_wrist : at_targets; }
  /// The decoupled method where it can be had, else Partial Pose, else Complete Pose.
  Method best() const;
};

/// Never throws for what the data lacks: what cannot be compared says why.
Comparison compareCampaigns(const Campaign& before_campaign, const Identification& before,
                            const Campaign& after_campaign, const Identification& after,
                            const BootstrapOptions& options = {});

}  // namespace stiffscope
