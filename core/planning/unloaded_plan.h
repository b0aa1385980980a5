#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/fitted_day.h"
#include "core/planning/candidates.h"

namespace stiffscope::planning {

/// How far an effect usually moves the reflectors, rms m: what is not known of it before a day.
inline constexpr double kUsualEffect = 1e-4;

/// One effect of the vocabulary, as far as a day of planned postures would show it.
struct EffectSight {
  std::string effect, detail;
  double detectable = 0.0;  ///< rms it moves the reflectors by where it stands out by three standard uncertainties, m
  double inflation = 0.0;   ///< of its standard uncertainty by the other effects; 1: told apart from all of them
};

/// What a sequence of postures would tell.
struct UnloadedSight {
  double predicted = 0.0;  ///< rms uncertainty of a reflector's 3-D position over the workspace, m, effects free
  double predicted_geometry = 0.0;      ///< the same by the rigid geometry alone
  std::vector<double> predicted_after;  ///< `predicted` by the first i + 1 postures
  std::vector<double> gain;             ///< by how much the predicted variance grows without posture i, a share
  std::vector<EffectSight> effects;
};

/// Linear model of a day without a load about the planned arm, as calibration fits it: axes, base, reflectors, sizes of
/// effects. Prior: calibration's of the geometry, kUsualEffect of each effect.
class UnloadedInformation {
 public:
  /// `workspace`: postures whose prediction counts. The columns of effects that depend on the posture alone come first.
  UnloadedInformation(const campaign::Campaign& campaign, const PlanningArm& arm,
                      const std::vector<JointVector>& workspace);

  /// Whitened equations of a posture by what does not depend on the order: three rows a reflector.
  std::vector<Eigen::MatrixXd> rowsOf(const std::vector<JointVector>& postures) const;
  Eigen::MatrixXd prior() const { return prior_.head(steady_).asDiagonal(); }
  /// Mean of J^T J over workspace and reflectors: trace(C W) is the variance of a position.
  const Eigen::MatrixXd& workspace() const { return workspace_; }

  /// What a sequence sees; `measured`: a day before it.
  UnloadedSight sightOf(const std::vector<JointVector>& sequence, bool details) const;
  /// Logarithm of the determinant of the information on effects that depend on the order (backlash, read-back, drift,
  /// growth, scale), usual sizes 1; `steady_inverse`: covariance of everything else by these postures.
  double orderValue(const std::vector<JointVector>& sequence, const Eigen::MatrixXd& steady_inverse) const;

 private:
  calibration::UnloadedDay dayOf(const std::vector<JointVector>& sequence) const;
  std::vector<Eigen::MatrixXd> allRows(const std::vector<JointVector>& sequence) const;
  void setPrior(const std::vector<JointVector>& workspace);

  campaign::Campaign day_;  ///< of the planned arm, without postures
  PlanningArm arm_;
  calibration::ArmFit fit_;
  Eigen::Index geometry_ = 0, steady_ = 0, all_ = 0;  ///< counts of columns: geometry, with steady effects, all
  Eigen::VectorXd prior_, usual_;                     ///< inverse variances of all; kUsualEffect's size of each effect
  Eigen::MatrixXd workspace_;
};

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
  JointVector q;                           ///< rad
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
