#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/planning/candidates.h"
#include "core/planning/design.h"

namespace stiffscope::planning {

/// What the choice is judged by, see designValue.
enum class PlanCriterion {
  balanced,     ///< D-optimal first; then no joint's sd may be large against what random postures give
  determinant,  ///< D-optimal
};

struct PlanOptions {
  int postures = 10;
  bool augment = false;            ///< the postures are added to those that the campaign has measured
  int candidates = 3000;           ///< more find a few per cent more information, and take longer
  int random_sets = 200;           ///< to hold the choice against
  double least_separation = 0.26;  ///< rad (15 deg) in some joint: postures as good as equal are no new evidence
  PlanCriterion criterion = PlanCriterion::balanced;
  std::uint64_t seed = 1;
  PlanningInputs inputs;
  PostureRules rules;
};

/// One posture to measure, in the order in which each adds most.
struct PlannedPosture {
  std::string id;
  Candidate candidate;
  Vector6d reading = Vector6d::Zero();                     ///< expected of the load cell, N and Nm in its axes
  Eigen::Vector3d pull_in_base = Eigen::Vector3d::Zero();  ///< unit, base_link axes
  double dexterity = 0.0;                                  ///< 1 / kappa at the flange, lengths over 1 m
  std::optional<double> tracker_distance;                  ///< from the station to the flange, m
  double log_det_gain = 0.0;  ///< by which this one raises log det of the information; infinite while that is singular
  JointVector sd;             ///< of the compliances with it and all before it, rad/Nm (standardDeviations)
  std::vector<std::vector<std::string>> separates;  ///< groups of effects that it tells apart

  PlannedPosture(std::string called, Candidate at) : id(std::move(called)), candidate(std::move(at)) {}
};

struct Plan {
  PlanningArm arm;
  bool usable = false;  ///< some joint's stiffness would be seen
  Remark reason;        ///< why not
  robot::JointMask unknown;
  PerJoint<Remark> not_seen;  ///< why a joint would not be
  int measured = 0;           ///< postures that are counted in already
  int asked = 0;              ///< postures asked for: `postures` may be fewer, where no more keep apart
  JointVector sd_measured;    ///< by those alone, rad/Nm; empty where there are none
  std::vector<PlannedPosture> postures;
  double log_determinant = 0.0;
  RandomPostures random_same, random_double;  ///< as many, and twice as many
  int candidates = 0, drawn = 0;
  std::optional<JointVector> compliance;  ///< of the identified campaign, to turn sd into that of k
};

/// Postures (and directions of pull) that identify best by the criterion, over random candidates that keep
/// the rules, for the information of the joints' compliances by the reflectors' displacements with the noise
/// expected there (and, after a campaign, the misfit its model left and the uncertainty of its effects). Standard
/// uncertainties are of the fit that weighs each reading by its noise, below which no method comes; the noise of the
/// load cell and what could hide are not in them. `identified`
/// is that campaign's identification, of readings corrected for these effects; it is needed to augment, and else places
/// sweeps, hook and load where it is given. Throws InputError for what cannot be planned for.
Plan planCampaign(const campaign::Campaign& campaign, const identification::Identification* identified,
                  const PlanOptions& options);

}  // namespace stiffscope::planning
