#include "core/improved/improved_subsets.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "core/identification/decoupled_partial_pose.h"
#include "core/improved/method_rows.h"
#include "core/improved/taken_off.h"

namespace stiffscope {

namespace {

using Weights = std::vector<double>;  // a posture of the campaign each: how often it takes part

/// Calls `visit` with the used postures of every subset of m of n, in order, or of a sample.
void forEachSubset(int n, int m, std::uint64_t most, std::uint64_t seed,
                   const std::function<void(const std::vector<char>&)>& visit) {
  std::vector<char> used(static_cast<std::size_t>(n), 0);
  if (subsetCount(n, m) <= most) {
    std::fill(used.begin(), used.begin() + m, 1);
    do visit(used);
    while (std::prev_permutation(used.begin(), used.end()));
    return;
  }
  std::mt19937_64 random(seed);
  std::vector<std::size_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::uint64_t draw = 0; draw < most; ++draw) {
    std::fill(used.begin(), used.end(), 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(m); ++i) {
      std::swap(order[i], order[i + random() % (order.size() - i)]);
      used[order[i]] = 1;
    }
    visit(used);
  }
}

/// Sum over a posture's points of what is left of their displacement.
double leftOf(const CaseEquations& one, const Vector6d& compliance) {
  const Eigen::VectorXd left = one.right - one.matrix * compliance;
  double sum = 0.0;
  for (Eigen::Index at = 0; at < left.size(); at += 3) sum += left.segment<3>(at).norm();
  return sum;
}

/// Sum over a posture's points of their displacement.
std::vector<double> displacementOf(const std::vector<CaseEquations>& rows) {
  std::vector<double> sums;
  for (const CaseEquations& one : rows) sums.push_back(leftOf(one, Vector6d::Zero()));
  return sums;
}

/// One kind of point, judged over the subsets.
class PointJudge {
 public:
  explicit PointJudge(std::vector<double> displacement)
      : displacement_(std::move(displacement)), count_(displacement_.size(), 0) {
    sum_.left_held_out.resize(displacement_.size(), 0.0);
  }

  void add(const std::vector<CaseEquations>& rows, const Vector6d& compliance, const std::vector<char>& used) {
    std::array<double, 2> left{}, whole{};
    for (std::size_t p = 0; p < rows.size(); ++p) {
      const auto side = static_cast<std::size_t>(used[p] != 0);
      const double own = leftOf(rows[p], compliance);
      left[side] += own;
      whole[side] += displacement_[p];
      if (side == 0) sum_.left_held_out[p] += own, ++count_[p];
    }
    sum_.compensated.used += 1.0 - left[1] / whole[1];
    sum_.compensated.held_out += 1.0 - left[0] / whole[0];
    sum_.compensated.all += 1.0 - (left[0] + left[1]) / (whole[0] + whole[1]);
  }

  double allPostures(const std::vector<CaseEquations>& rows, const Vector6d& compliance) const {
    double left = 0.0;
    for (const CaseEquations& one : rows) left += leftOf(one, compliance);
    return 1.0 - left / std::accumulate(displacement_.begin(), displacement_.end(), 0.0);
  }

  SubsetJudgement mean(double subsets) const {
    SubsetJudgement mean = sum_;
    mean.compensated.used /= subsets;
    mean.compensated.held_out /= subsets;
    mean.compensated.all /= subsets;
    for (std::size_t p = 0; p < count_.size(); ++p)
      mean.left_held_out[p] /= static_cast<double>(std::max<std::uint64_t>(1, count_[p]));
    return mean;
  }

 private:
  std::vector<double> displacement_;
  std::vector<std::uint64_t> count_;
  SubsetJudgement sum_;
};

/// The effects' parameters fitted on postures with weights, as steps along the columns of the spread.
class EffectRefit {
 public:
  explicit EffectRefit(const ImprovedModel& model)
      : effects_(model.effects), from_parameters_(model.spread.parameters.completeOrthogonalDecomposition().pseudoInverse()) {}

  /// `poses` and `weights` of the method's postures; others do not take part.
  Eigen::VectorXd steps(const std::vector<CaseEquations>& rows, const Weights& weights) const {
    const auto& postures = effects_.fit.data.postures;
    Weights own(postures.size(), 0.0);
    for (std::size_t p = 0; p < rows.size(); ++p) {
      for (std::size_t g = 0; g < postures.size(); ++g) {
        if (postures[g].pose == rows[p].posture) own[g] = weights[p];
      }
    }
    const Eigen::VectorXd change = parametersFrom(effects_, own) - effects_.parameters();
    return from_parameters_ * change(effects_.free);
  }

 private:
  const EffectFit& effects_;
  Eigen::MatrixXd from_parameters_;
};

Vector6d solved(const MethodRows& rows, const Weights& weights, bool decoupled, const JointMask& unknown) {
  NormalEquations first, second;
  const auto addTo = [&](const CaseEquations& one, double weight, NormalEquations& sum) {
    const NormalEquations own = normalEquations(one);
    sum += {weight * own.matrix, weight * own.right};
  };
  for (std::size_t p = 0; p < weights.size(); ++p) {
    if (weights[p] == 0.0) continue;
    addTo(rows.solved[p], weights[p], first);
    if (decoupled) addTo(rows.targets[p], weights[p], second);
  }
  return decoupled ? solveDecoupled(first, second, unknown) : solveNormal(first, unknown);
}

class MethodJudge {
 public:
  MethodJudge(const Campaign& measured, const IdentifyOptions& options, const ImprovedModel& model, Method which)
      : options_(options), model_(model), which_(which), own_(model.with.of(which)), refit_(model),
        rows_(rowsFrom(measured)), true_(trueRows(measured)) {}

  void fill(MethodResult& out) const {
    if (!rows_.movable()) return;
    const MethodRows here = rows_.at(Eigen::VectorXd::Zero(model_.spread.parameters.cols()));
    PointJudge at_wrist(displacementOf(true_.wrist)), at_targets(displacementOf(true_.targets));
    const bool wrist = !here.wrist.empty() && true_.wrist.size() == here.wrist.size();
    if (true_.targets.size() != here.targets.size()) return;
    out.subsets = study(wrist, at_wrist, at_targets);
    const Vector6d& c = own_.estimate.compliance;
    if (wrist) out.at_wrist = Compensation{at_wrist.allPostures(here.wrist, c), out.subsets.at_wrist.compensated};
    out.at_targets = Compensation{at_targets.allPostures(here.targets, c), out.subsets.at_targets.compensated};
    out.bootstrap = bootstrap();
  }

 private:
  MethodRows rowsAt(const Campaign& measured, const Eigen::VectorXd& parameters, TakenOff what) const {
    return methodRows(withoutEffects(measured, model_.effects, parameters, what), model_.with, which_);
  }

  MovingRows rowsFrom(const Campaign& measured) const {
    const Eigen::MatrixXd& columns = model_.spread.parameters;
    std::vector<MethodRows> moved;
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      Eigen::VectorXd parameters = model_.effects.parameters();
      for (std::size_t i = 0; i < model_.effects.free.size(); ++i)
        parameters[model_.effects.free[i]] += columns(static_cast<Eigen::Index>(i), k);
      moved.push_back(rowsAt(measured, parameters, TakenOff::loads));
    }
    return {rowsAt(measured, model_.effects.parameters(), TakenOff::loads), std::move(moved)};
  }

  MethodRows trueRows(const Campaign& measured) const {
    return rowsAt(measured, model_.effects.parameters(), TakenOff::measurement);
  }

  bool decoupled() const { return which_ == Method::decoupled_partial_pose; }

  /// Effects and springs anew on these postures: the equations with those effects, and the compliances.
  std::pair<MethodRows, Vector6d> anew(const Weights& weights) const {
    const MethodRows here = rows_.at(refit_.steps(true_.targets, weights));
    return {here, solved(here, weights, decoupled(), own_.estimate.identifiable)};
  }

  SubsetStudy study(bool wrist, PointJudge& at_wrist, PointJudge& at_targets) const {
    SubsetStudy study;
    const SubsetOptions& asked = options_.subsets;
    study.of = static_cast<int>(rows_.postures());
    study.size = asked.size > 0 ? asked.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
    if (study.size < 1 || study.size >= study.of) return study;
    constexpr std::uint64_t kMost = 1000;
    const std::uint64_t most = std::min({kMost, asked.sample, std::max<std::uint64_t>(asked.most_all, 1)});
    study.every_subset = subsetCount(study.of, study.size) <= most;
    forEachSubset(study.of, study.size, most, asked.seed, [&](const std::vector<char>& used) {
      const auto [rows, compliance] = anew(Weights(used.begin(), used.end()));
      study.compliances.push_back(compliance);
      if (wrist) at_wrist.add(rows.wrist, compliance, used);
      at_targets.add(rows.targets, compliance, used);
    });
    const auto subsets = static_cast<double>(study.compliances.size());
    if (wrist) study.at_wrist = at_wrist.mean(subsets);
    study.at_targets = at_targets.mean(subsets);
    return study;
  }

  PostureBootstrap bootstrap() const {
    PostureBootstrap result;
    std::mt19937_64 random(options_.bootstrap.seed);
    const std::size_t n = rows_.postures();
    for (int draw = 0; draw < options_.bootstrap.draws; ++draw) {
      Weights weights(n, 0.0);
      for (std::size_t k = 0; k < n; ++k) weights[random() % n] += 1.0;
      result.compliances.push_back(anew(weights).second);
    }
    return result;
  }

  const IdentifyOptions& options_;
  const ImprovedModel& model_;
  Method which_;
  const MethodResult& own_;
  EffectRefit refit_;
  MovingRows rows_;
  MethodRows true_;
};

/// Displacements by case of the campaign with only the measurement's faults taken off.
void describeDisplacements(const Campaign& measured, ImprovedModel& model) {
  Identification& with = model.with;
  const Campaign truth =
      withoutEffects(measured, model.effects, model.effects.parameters(), TakenOff::measurement);
  for (const Method which : {Method::decoupled_partial_pose, Method::complete_pose, Method::partial_pose}) {
    if (!with.of(which).available) continue;
    const LoadedArm arm = loadedArm(truth, with.of(which).geometry, with.frames.wrist, with.steps);
    const auto scaled = [](const std::vector<double>& now, const std::vector<double>& before, double share) {
      const double sum = std::accumulate(now.begin(), now.end(), 0.0);
      return sum > 0.0 ? share * std::accumulate(before.begin(), before.end(), 0.0) / sum : share;
    };
    std::vector<double> targets, wrist;
    for (const LoadCase& one : arm.cases) {
      double sum = 0.0;
      for (const TargetMove& move : one.targets) sum += move.displacement().norm();
      targets.push_back(sum / static_cast<double>(one.targets.size()));
    }
    for (const WristMove& move : arm.wrist) wrist.push_back(move.displacement().norm());
    if (targets.size() != with.target_displacement.size()) return;
    if (with.noise) with.noise->at_targets = scaled(targets, with.target_displacement, with.noise->at_targets);
    with.target_displacement = targets;
    if (wrist.size() != with.wrist_displacement.size()) return;
    if (with.noise && with.noise->at_wrist)
      with.noise->at_wrist = scaled(wrist, with.wrist_displacement, *with.noise->at_wrist);
    with.wrist_displacement = wrist;
    return;
  }
}

}  // namespace

void judgeImproved(const Campaign& measured, const IdentifyOptions& options, ImprovedModel& model) {
  for (const Method which : kMethods) {
    if (!model.with.of(which).available) continue;
    MethodJudge(measured, options, model, which).fill(model.with.methods[static_cast<std::size_t>(which)]);
  }
  describeDisplacements(measured, model);
}

}  // namespace stiffscope
