#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/planning/candidates.h"
#include "core/planning/unloaded_information.h"

namespace stiffscope::planning {

struct UnloadedPlanOptions {
  int postures = 40;
  int candidates = 400;
  int random_sets = 20;            ///< to hold the choice against
  double least_separation = 0.26;  ///< rad (15 deg) in some joint
  std::uint64_t seed = 1;
  PlanningInputs inputs;
  PostureRules rules;  ///< of a large arm: clearances shrink with a smaller arm's reach
};

/// One posture to measure, in the order of the day.
struct UnloadedPosture {
  std::string id;
  Vector6d q = Vector6d::Zero();           ///< rad
  std::optional<double> tracker_distance;  ///< from the station to the flange, m
  double predicted = 0.0;                  ///< rms uncertainty of a position with it and all before it, m
  double gain = 0.0;                       ///< by how much the predicted variance grows without it, a share
};

/// Medians over random sets of postures that keep the same rules, in random order.
struct RandomSight {
  int postures = 0;
  double predicted = 0.0, predicted_geometry = 0.0;  ///< m
  std::vector<EffectSight> effects;
};

struct UnloadedPlan {
  PlanningArm arm;
  int asked = 0, candidates = 0, drawn = 0;
  std::vector<UnloadedPosture> postures;
  UnloadedSight sight;
  RandomSight random_same, random_double;
};

/// Postures that calibrate an arm without a load: of random candidates that keep the rules those by which the mean
/// variance of a reflector's predicted position over the workspace (other candidates) is least, sizes of effects that
/// depend on the posture unknown beside the geometry (I-optimal): greedily, then by exchanges (Fedorov's, as
/// exchangeDesign). Then an order, by exchanges too, in which effects of the order (backlash, read-back, drift, growth,
/// scale) are told apart best (D-optimal). Where the campaign has unloaded readings, arm, reflectors, tracker and what
/// the model leaves are as they calibrate it. Throws InputError for what cannot be planned for.
UnloadedPlan planUnloaded(const campaign::Campaign& campaign, const UnloadedPlanOptions& options);

}  // namespace stiffscope::planning
