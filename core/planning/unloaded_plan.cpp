#include "core/planning/unloaded_plan.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/calibration/calibrate.h"
#include "core/io/input_error.h"
#include "core/numerics/parallel.h"
#include "core/numerics/random.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::planning {

namespace {

/// Straight from the base over the joints to the flange, m.
double reachOf(const robot::Robot& arm) {
  double reach = 0.0;
  for (std::size_t j = 1; j < arm.axes_in_base_at_zero.size(); ++j)
    reach += (arm.axes_in_base_at_zero[j].point - arm.axes_in_base_at_zero[j - 1].point).norm();
  return reach + (arm.base_from_flange_at_zero.translation() - arm.axes_in_base_at_zero.back().point).norm();
}

PostureRules scaledRules(PostureRules rules, const robot::Robot& arm) {
  constexpr double kLarge = 3.0;  // m, of the arms that the clearances are meant for
  const double share = std::min(1.0, reachOf(arm) / kLarge);
  for (double* length : {&rules.least_height, &rules.body_clearance, &rules.sight_clearance}) *length *= share;
  return rules;
}

std::size_t below(std::size_t count, numerics::RandomStream& random) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

void shuffle(std::vector<std::size_t>& order, numerics::RandomStream& random) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[below(i, random)]);
}

class UnloadedPlanner {
 public:
  UnloadedPlanner(const campaign::Campaign& campaign, const UnloadedPlanOptions& options)
      : campaign_(campaign), options_(options), random_(options.seed, "unloaded plan") {}

  UnloadedPlan run() {
    checkOptions();
    placeArm();
    plan_.asked = options_.postures;
    const PostureRules rules = scaledRules(options_.rules, plan_.arm.geometry.arm);
    const CandidateDraw draw = drawCandidates(plan_.arm, rules, options_.candidates, options_.seed);
    plan_.candidates = static_cast<int>(draw.kept.size()), plan_.drawn = draw.drawn;
    for (const Candidate& one : draw.kept) candidates_.push_back(one.q);
    constexpr int kWorkspace = 150;
    std::vector<JointVector> workspace;
    for (const Candidate& one : drawCandidates(plan_.arm, rules, kWorkspace, options_.seed + 1).kept)
      workspace.push_back(one.q);
    plan_.arm.assumed.emplace_back(RemarkId::usual_effects, kUsualEffect);
    information_.emplace(campaign_, plan_.arm, workspace);
    rows_ = information_->rowsOf(candidates_);
    choose();
    order();
    describe();
    const int count = static_cast<int>(chosen_.size());
    plan_.random_same = randomSight(count), plan_.random_double = randomSight(2 * count);
    return std::move(plan_);
  }

 private:
  void checkOptions() const {
    if (options_.postures < 2)
      throw io::InputError({"--postures"}, std::to_string(options_.postures), "expected 2 or more postures");
    if (options_.candidates < options_.postures)
      throw io::InputError({"--candidates"}, std::to_string(options_.candidates),
                           "expected at least as many candidates as postures");
  }

  /// As a measured day calibrates it, where there is one.
  void placeArm() {
    plan_.arm = unloadedPlanningArm(campaign_, options_.inputs);
    if (!campaign_.loading || !campaign_.states) return;
    const calibration::Calibration day = calibration::calibrate(campaign_, {});
    if (!day.reason.empty()) return;
    PlanningArm& arm = plan_.arm;
    const calibration::ArmFit& fit = day.best().fit;
    arm.geometry.arm = fit.arm(campaign_.robot);
    const Eigen::Isometry3d flange_from_zero = arm.geometry.arm.base_from_flange_at_zero.inverse();
    arm.targets_in_flange.clear();
    for (const Eigen::Vector3d& target : fit.targetsAtZero())
      arm.targets_in_flange.push_back(flange_from_zero * target);
    if (!arm.station && campaign_.tracker) arm.station = fit.basePointsMotion() * day.day.station;
    arm.misfit = fit.model_sd;
    std::erase_if(arm.assumed, [&](const Remark& one) {
      return one.is(RemarkId::reflectors_on_ring) || (one.is(RemarkId::tracker_not_placed) && arm.station);
    });
    arm.assumed.emplace_back(RemarkId::calibrated_before, day.day.postures.size(), arm.misfit);
  }

  bool apart(std::size_t candidate, std::size_t but) const {
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      if (i != but &&
          (candidates_[chosen_[i]] - candidates_[candidate]).cwiseAbs().maxCoeff() < options_.least_separation)
        return false;
    }
    return true;
  }

  /// The candidate that lowers trace(C W) most, and by how much: tr((1 + J C J^T)^-1 J C W C J^T).
  std::pair<std::size_t, double> best(const Eigen::MatrixXd& covariance, std::size_t but) const {
    const Eigen::MatrixXd weighted = covariance * information_->workspace() * covariance;
    std::vector<double> gains(candidates_.size(), -1.0);
    numerics::onAllCores(candidates_.size(), [&](std::size_t c) {
      if (apart(c, but)) gains[c] = gainOf(rows_[c], covariance, weighted);
    });
    const auto found = std::max_element(gains.begin(), gains.end());
    return {static_cast<std::size_t>(found - gains.begin()), *found};
  }

  static double gainOf(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& covariance,
                       const Eigen::MatrixXd& weighted) {
    Eigen::MatrixXd among = propagated(rows, covariance);
    among.diagonal().array() += 1.0;
    return solvePositive(among, propagated(rows, weighted)).trace();
  }

  static Eigen::MatrixXd inverse(const Eigen::MatrixXd& normal) {
    return solveSymmetric(normal, Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  }

  void choose() {
    Eigen::MatrixXd normal = information_->prior();
    const auto none = static_cast<std::size_t>(-1);
    for (int i = 0; i < options_.postures; ++i) {
      const auto [candidate, gain] = best(inverse(normal), none);
      if (gain < 0.0) break;  // no more keep apart
      chosen_.push_back(candidate);
      normal.noalias() += rows_[candidate].transpose() * rows_[candidate];
    }
    constexpr int kPasses = 3;
    bool changed = true;
    for (int pass = 0; pass < kPasses && changed; ++pass) {
      changed = false;
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const Eigen::MatrixXd& own = rows_[chosen_[i]];
        const Eigen::MatrixXd without = normal - own.transpose() * own;
        const Eigen::MatrixXd covariance = inverse(without);
        const double before = gainOf(own, covariance, covariance * information_->workspace() * covariance);
        const auto [candidate, gain] = best(covariance, i);
        constexpr double kWorth = 1e-6;
        if (gain <= before * (1.0 + kWorth)) continue;
        chosen_[i] = candidate;
        normal = without + rows_[candidate].transpose() * rows_[candidate];
        changed = true;
      }
    }
    steady_inverse_ = inverse(normal);
  }

  std::vector<JointVector> sequence(const std::vector<std::size_t>& order) const {
    std::vector<JointVector> all;
    for (const std::size_t one : order) all.push_back(candidates_[one]);
    return all;
  }

  /// Random orders, the best of them improved by swaps.
  void order() {
    constexpr std::size_t kStarts = 30, kSwaps = 300;
    const auto value = [&](const std::vector<std::size_t>& order) {
      return information_->orderValue(sequence(order), steady_inverse_);
    };
    double reached = -1e300;
    std::vector<std::size_t> tried = chosen_;
    for (std::size_t start = 0; start < kStarts; ++start) {
      shuffle(tried, random_);
      const double now = value(tried);
      if (now > reached) reached = now, chosen_ = tried;
    }
    for (std::size_t swap = 0; swap < kSwaps && chosen_.size() > 2; ++swap) {
      tried = chosen_;
      std::swap(tried[below(tried.size(), random_)], tried[below(tried.size(), random_)]);
      const double now = value(tried);
      if (now > reached) reached = now, chosen_ = tried;
    }
  }

  void describe() {
    plan_.sight = information_->sightOf(sequence(chosen_), true);
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      UnloadedPosture posture;
      posture.id = fmt::format("plan{}", i + 1);
      posture.q = candidates_[chosen_[i]];
      if (plan_.arm.station) {
        const robot::Robot& arm = plan_.arm.geometry.arm;
        posture.tracker_distance =
            (robot::flangeAt(arm, robot::postureAt(arm, posture.q)).translation() - *plan_.arm.station).norm();
      }
      posture.predicted = plan_.sight.predicted_after[i], posture.gain = plan_.sight.gain[i];
      plan_.postures.push_back(std::move(posture));
    }
  }

  RandomSight randomSight(int postures) {
    RandomSight random;
    random.postures = std::min(postures, static_cast<int>(candidates_.size()));
    std::vector<std::size_t> all(candidates_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<double> predicted, geometry;
    std::vector<std::vector<double>> detectable(plan_.sight.effects.size()), inflation = detectable;
    for (int set = 0; set < options_.random_sets; ++set) {
      shuffle(all, random_);
      const UnloadedSight sight = information_->sightOf(
          sequence({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(random.postures)}), false);
      predicted.push_back(sight.predicted), geometry.push_back(sight.predicted_geometry);
      for (std::size_t e = 0; e < sight.effects.size(); ++e) {
        detectable[e].push_back(sight.effects[e].detectable);
        inflation[e].push_back(sight.effects[e].inflation);
      }
    }
    random.predicted = numerics::upperMedian(std::move(predicted));
    random.predicted_geometry = numerics::upperMedian(std::move(geometry));
    random.effects = plan_.sight.effects;
    for (std::size_t e = 0; e < random.effects.size(); ++e) {
      random.effects[e].detectable = numerics::upperMedian(std::move(detectable[e]));
      random.effects[e].inflation = numerics::upperMedian(std::move(inflation[e]));
    }
    return random;
  }

  const campaign::Campaign& campaign_;
  const UnloadedPlanOptions& options_;
  numerics::RandomStream random_;
  std::vector<JointVector> candidates_;
  std::optional<UnloadedInformation> information_;
  std::vector<Eigen::MatrixXd> rows_;
  std::vector<std::size_t> chosen_;
  Eigen::MatrixXd steady_inverse_;
  UnloadedPlan plan_;
};

}  // namespace

UnloadedPlan planUnloaded(const campaign::Campaign& campaign, const UnloadedPlanOptions& options) {
  return UnloadedPlanner(campaign, options).run();
}

}  // namespace stiffscope::planning
