#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/comparison/deflection_avoided.h"
#include "core/comparison/matched_postures.h"
#include "core/comparison/paired_fit.h"
#include "core/comparison/remarks.h"
#include "core/identification/identification.h"
#include "core/identification/identify.h"
#include "metrology/remark.h"

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

/// What double encoders take away of a joint by the gear's own measurement (identification/transmission.h): between a
/// state whose motor is held and one whose link side is, c_before - c_after should be the gear's compliance.
struct GearCheck {
  Uncertain compliance;  ///< of the gear by its two encoders, rad/Nm, from the campaign that has it better
  double p_value = 0.0;  ///< two-sided, of the difference of compliances and the gear being one number
};

/// The model that each day's data support (extended_model::supportedModel): identified from readings corrected for its
/// effects, with intervals that hold what could still hide. Null: joint springs alone, of both.
struct SupportedModels {
  const identification::Identification *before = nullptr, *after = nullptr;
  bool effects = false;    ///< some were added to either
  bool explained = false;  ///< neither leaves a gap that no effect explains

  bool given() const { return before != nullptr && after != nullptr; }
};

/// One joint in both campaigns.
struct JointChange {
  bool comparable = false;
  Remark reason;  ///< why not: which campaign does not identify it, and why
  /// c_after - c_before, rad/Nm, from the same postures where enough correspond: what both states share cancels
  /// (PairedFit). This is the result; what follows of stiffnesses is each campaign's own identification.
  Uncertain difference;
  double p_value = 0.0;  ///< two-sided, of no difference; not a number where an uncertainty is
  double p_holm = 0.0;   ///< the same corrected for the number of joints (holm)
  Uncertain taken;       ///< share of the compliance before that is gone; not a number where that is not above zero
  Uncertain avoided;     ///< share of the deflection at the reflectors that this avoids (avoidedByUnit); not a number
                         ///< where no posture corresponds
  Uncertain before, after;   ///< k of each campaign's model (SupportedModels; else of its identification), Nm/rad
  Uncertain ratio;           ///< after / before, to first order: by springs alone, correlation included, or of models
                             ///< with effects, as independent. Keeps the bias of both unless ratiosHold
  double correlation = 0.0;  ///< of the two scatter errors, by the postures that both share
  Remark mark;               ///< of either entry: negative or imprecise; else empty
  std::optional<GearCheck> gear;  ///< empty where neither campaign measures the gear, or the loops are not these
};

struct StiffnessChange {
  bool available = false;
  Remark reason;
  PerJoint<JointChange> joints;  ///< as many as the machine has
  bool same_postures = false;    ///< differences are of fits on the postures that correspond
  bool by_models = false;        ///< they are not: differences are of the two models, with their intervals
  std::size_t postures = 0;      ///< that correspond
  /// What the joints' `avoided` leave of the share of the deflection avoided at the reflectors; not a number where none
  /// of these is one.
  double avoided_rest = 0.0;
};

/// Compares by one method. The test is on the difference of compliances, whose error is nearly normal where that of
/// k = 1/c is heavy-tailed: t = (c_a - c_b) / u against Student's distribution, u and its degrees of freedom those of
/// PairedFit. `before` and `after` are by joint springs alone: on the same postures what they miss cancels, and what
/// effects would explain needs no parameters that the difference had to pay for. Where postures do not correspond
/// nothing cancels, and the difference is that of `models` where these are given, U the root of the sum of squares.
StiffnessChange compareStiffness(const campaign::Campaign& before_campaign,
                                 const identification::Identification& before, const campaign::Campaign& after_campaign,
                                 const identification::Identification& after, identification::Method method,
                                 const MatchedPostures& matched, const SupportedModels& models = {});

/// The method shown first of those by which the two campaigns are compared.
std::optional<identification::ShownFirst> comparedFirst(const identification::Identification& before,
                                                        const identification::Identification& after,
                                                        const std::array<StiffnessChange, 3>& methods);

/// Two campaigns of one machine side by side: double encoders inactive and active, or before and after a
/// repair.
struct Comparison {
  bool comparable = false;       ///< some stiffness or some deflection is
  Remark reason;                 ///< why nothing is
  std::vector<Remark> cautions;  ///< what a reader must know before believing the numbers
  MatchedPostures matched;
  std::array<StiffnessChange, 3> methods;  ///< by Method
  CommonResidual residual;                 ///< whether ratios are to be believed: isNoise
  DeflectionAvoided at_wrist, at_targets;
  bool models_hold = false;  ///< ratios are of models with effects that leave nothing unexplained

  /// Whether ratios of stiffnesses are free of the bias of both.
  bool ratiosHold() const { return residual.isNoise() || models_hold; }

  const StiffnessChange& of(identification::Method method) const { return methods[static_cast<std::size_t>(method)]; }
  /// The deflection avoided at P_wrist where it is measured, else at the reflectors.
  bool judgedAtWrist() const { return at_wrist.available; }
  const DeflectionAvoided& avoided() const { return at_wrist.available ? at_wrist : at_targets; }
  /// The method that both campaigns together show first (identification/shown_first.h) of those comparable; Complete
  /// Pose where none is.
  std::optional<identification::ShownFirst> shown_first;
  identification::Method best() const;
};

/// Never throws for what the data lacks: what cannot be compared says why.
Comparison compareCampaigns(const campaign::Campaign& before_campaign, const identification::Identification& before,
                            const campaign::Campaign& after_campaign, const identification::Identification& after,
                            const SupportedModels& models = {}, const BootstrapOptions& options = {});

}  // namespace stiffscope::comparison
