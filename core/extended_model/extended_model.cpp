#include "core/extended_model/extended_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

#include "core/extended_model/corrected_campaign.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"
#include "core/identification/identify.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/outliers.h"
#include "core/identification/warnings.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

/// Judges a method of `model.with` with the effects in the model: displacements are the machine's own, and on every
/// subset of postures (all up to a thousand, else a thousand drawn) effects and springs are fitted anew, the effects by
/// one linear step, the equations moved along with them to first order. Fills shares, residuals, `subsets`, and the
/// bootstrap where it is asked for, of every available method.
void evaluateExtended(const campaign::Campaign& measured, const identification::IdentifyOptions& options,
                      ExtendedModel& model);

/// The equations of one method in its own geometry, a posture each, at known compliances (K_c, middle posture).
struct MethodRows {
  std::vector<identification::CaseEquations>
      solved;  ///< what the method solves first: pose (normalised), reflectors, P_wrist
  std::vector<identification::CaseEquations> targets;  ///< the reflectors', which the decoupled method solves second
  std::vector<identification::CaseEquations> wrist;    ///< P_wrist's; empty where not measured
};

/// Of `method` in `result`, whose frames, length and compliances stand, from the readings of `campaign`.
MethodRows methodRows(const campaign::Campaign& campaign, const identification::Identification& result,
                      identification::Method method);

/// rows + sum_k step_k (moved_k - rows): equations that change with further parameters, to first order. All must have
/// the same postures and points.
class MovingRows {
 public:
  MovingRows(MethodRows at, std::vector<MethodRows> moved);

  /// False where a moved campaign does not have the same postures and points: then nothing moves.
  bool movable() const { return movable_; }
  std::size_t postures() const { return at_.targets.size(); }
  MethodRows at(const Eigen::VectorXd& steps) const;

 private:
  MethodRows at_;
  std::vector<MethodRows> moved_;  ///< less `at_`
  bool movable_ = true;
};

namespace {

/// The values alone: no subsets, no bootstrap, no outliers sought.
identification::IdentifyOptions valuesOnly(identification::IdentifyOptions options) {
  options.subsets.size = std::numeric_limits<int>::max();
  options.bootstrap.draws = 0;
  options.robust = false;
  return options;
}

/// S of Sigma = S S^T by eigenvectors, the parameters in their own standard deviations.
Eigen::MatrixXd rootOf(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = sd.unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 0.0; });
  const SymmetricEigen own = symmetricEigen(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  return sd.asDiagonal() * own.vectors * own.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The effects' parameters moved along a column.
Eigen::VectorXd movedBy(const EffectFit& effects, const Eigen::VectorXd& column) {
  Eigen::VectorXd parameters = effects.parameters();
  for (std::size_t i = 0; i < effects.free.size(); ++i)
    parameters[effects.free[i]] += column[static_cast<Eigen::Index>(i)];
  return parameters;
}

void findSpread(const campaign::Campaign& used, const identification::IdentifyOptions& options, ExtendedModel& model) {
  EffectSpread& spread = model.spread;
  spread.parameters = rootOf(model.effects.covariance);
  for (auto& columns : spread.compliance) columns.setZero(6, spread.parameters.cols());
  for (Eigen::Index k = 0; k < spread.parameters.cols(); ++k) {
    const campaign::Campaign moved =
        withoutEffects(used, model.effects, movedBy(model.effects, spread.parameters.col(k)), TakenOff::everything);
    const identification::Identification there = identification::identify(moved, options);
    for (const identification::Method which : identification::kMethods) {
      const identification::MethodResult &here = model.with.of(which), &other = there.of(which);
      if (!here.available || !other.available) continue;
      spread.compliance[static_cast<std::size_t>(which)].col(k) = other.estimate.compliance - here.estimate.compliance;
    }
  }
}

/// Equations that a method fits: three a reflector and case; of Complete Pose six a case.
double rowsOf(const identification::MethodResult& method, identification::Method which) {
  double rows = 0.0;
  for (const identification::CaseEquations& one : method.target_rows)
    rows += which == identification::Method::complete_pose ? 6.0 : static_cast<double>(one.right.size());
  return rows;
}

void addEffectsUncertainty(ExtendedModel& model) {
  const auto taken = static_cast<double>(model.effects.free.size());
  for (const identification::Method which : identification::kMethods) {
    identification::MethodResult& method = model.with.methods[static_cast<std::size_t>(which)];
    if (!method.available) continue;
    identification::StiffnessEstimate& estimate = method.estimate;
    const auto unknowns =
        static_cast<double>(std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true));
    const double rows = rowsOf(method, which);
    if (rows > unknowns + taken) {
      const double factor = (rows - unknowns) / (rows - unknowns - taken);
      estimate.sigma *= std::sqrt(factor);
      estimate.parts.scatter *= factor;
    }
    const auto& columns = model.spread.compliance[static_cast<std::size_t>(which)];
    estimate.parts.effects = columns * columns.transpose();
    estimate.covariance = estimate.parts.total();
  }
}

}  // namespace

ExtendedModel extendModel(const campaign::Campaign& campaign, EffectFit effects,
                          const identification::IdentifyOptions& options) {
  ExtendedModel model;
  model.effects = std::move(effects);
  model.without = identification::identify(campaign, options);
  // Effects of size zero change nothing and have no covariance to propagate.
  if (model.effects.free.empty()) {
    model.with = model.without;
    model.campaign = campaign;
    return model;
  }
  std::vector<identification::LeftOutPosture> left_out;
  model.campaign = withoutEffects(campaign, model.effects, model.effects.parameters(), TakenOff::everything, &left_out);
  identification::IdentifyOptions own = valuesOnly(options);
  own.robust = options.robust;
  model.with = identification::identify(model.campaign, own);
  model.with.left_out.insert(model.with.left_out.end(), left_out.begin(), left_out.end());
  const campaign::Campaign used =
      model.with.robust ? identification::withoutPostures(campaign, model.with.outlying) : campaign;
  findSpread(used, valuesOnly(options), model);
  addEffectsUncertainty(model);
  evaluateExtended(used, options, model);
  model.with.cautions = identification::warningsOf(model.campaign, model.with);
  return model;
}

namespace {

using numerics::Weights;  // of the postures of the campaign

/// Sum over a posture's points of what is left of their displacement.
double leftOf(const identification::CaseEquations& one, const Vector6d& compliance) {
  const Eigen::VectorXd left = one.right - one.matrix * compliance;
  double sum = 0.0;
  for (Eigen::Index at = 0; at < left.size(); at += 3) sum += left.segment<3>(at).norm();
  return sum;
}

/// Sum over a posture's points of their displacement.
std::vector<double> displacementOf(const std::vector<identification::CaseEquations>& rows) {
  std::vector<double> sums;
  for (const identification::CaseEquations& one : rows) sums.push_back(leftOf(one, Vector6d::Zero()));
  return sums;
}

/// One kind of point, judged over the subsets.
class PointJudge {
 public:
  explicit PointJudge(std::vector<double> displacement)
      : displacement_(std::move(displacement)), count_(displacement_.size(), 0) {
    sum_.left_held_out.resize(displacement_.size(), 0.0);
  }

  void add(const std::vector<identification::CaseEquations>& rows, const Vector6d& compliance, const Weights& used) {
    std::array<double, 2> left{}, whole{};
    for (std::size_t p = 0; p < rows.size(); ++p) {
      const auto side = static_cast<std::size_t>(used[p] != 0.0);
      const double own = leftOf(rows[p], compliance);
      left[side] += own;
      whole[side] += displacement_[p];
      if (side == 0) sum_.left_held_out[p] += own, ++count_[p];
    }
    sum_.compensated.used += 1.0 - left[1] / whole[1];
    sum_.compensated.held_out += 1.0 - left[0] / whole[0];
    sum_.compensated.all += 1.0 - (left[0] + left[1]) / (whole[0] + whole[1]);
  }

  double allPostures(const std::vector<identification::CaseEquations>& rows, const Vector6d& compliance) const {
    double left = 0.0;
    for (const identification::CaseEquations& one : rows) left += leftOf(one, compliance);
    return 1.0 - left / std::accumulate(displacement_.begin(), displacement_.end(), 0.0);
  }

  identification::SubsetJudgement mean(double subsets) const {
    identification::SubsetJudgement mean = sum_;
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
  identification::SubsetJudgement sum_;
};

/// The effects' parameters fitted on postures with weights, as steps along the columns of the spread.
class EffectRefit {
 public:
  explicit EffectRefit(const ExtendedModel& model)
      : effects_(model.effects), from_parameters_(pseudoInverse(model.spread.parameters)) {}

  /// `poses` and `weights` of the method's postures; others do not take part.
  Eigen::VectorXd steps(const std::vector<identification::CaseEquations>& rows, const Weights& weights) const {
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

Vector6d solved(const MethodRows& rows, const Weights& weights, bool decoupled, const robot::JointMask& unknown) {
  identification::NormalEquations first, second;
  const auto addTo = [&](const identification::CaseEquations& one, double weight,
                         identification::NormalEquations& sum) {
    const identification::NormalEquations own = identification::normalEquations(one);
    sum += {weight * own.matrix, weight * own.right};
  };
  for (std::size_t p = 0; p < weights.size(); ++p) {
    if (weights[p] == 0.0) continue;
    addTo(rows.solved[p], weights[p], first);
    if (decoupled) addTo(rows.targets[p], weights[p], second);
  }
  return decoupled ? identification::solveDecoupled(first, second, unknown)
                   : identification::solveNormal(first, unknown);
}

class MethodJudge {
 public:
  MethodJudge(const campaign::Campaign& measured, const identification::IdentifyOptions& options,
              const ExtendedModel& model, identification::Method which)
      : options_(options),
        model_(model),
        which_(which),
        own_(model.with.of(which)),
        refit_(model),
        rows_(rowsFrom(measured)),
        true_(trueRows(measured)) {}

  void fill(identification::MethodResult& out) const {
    if (!rows_.movable()) return;
    const MethodRows here = rows_.at(Eigen::VectorXd::Zero(model_.spread.parameters.cols()));
    PointJudge at_wrist(displacementOf(true_.wrist)), at_targets(displacementOf(true_.targets));
    const bool wrist = !here.wrist.empty() && true_.wrist.size() == here.wrist.size();
    if (true_.targets.size() != here.targets.size()) return;
    out.subsets = study(wrist, at_wrist, at_targets);
    const Vector6d& c = own_.estimate.compliance;
    if (wrist)
      out.at_wrist =
          identification::Compensation{at_wrist.allPostures(here.wrist, c), out.subsets.at_wrist.compensated};
    out.at_targets =
        identification::Compensation{at_targets.allPostures(here.targets, c), out.subsets.at_targets.compensated};
    out.bootstrap = bootstrap();
  }

 private:
  MethodRows rowsAt(const campaign::Campaign& measured, const Eigen::VectorXd& parameters, TakenOff what) const {
    return methodRows(withoutEffects(measured, model_.effects, parameters, what), model_.with, which_);
  }

  MovingRows rowsFrom(const campaign::Campaign& measured) const {
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

  MethodRows trueRows(const campaign::Campaign& measured) const {
    return rowsAt(measured, model_.effects.parameters(), TakenOff::measurement);
  }

  bool decoupled() const { return which_ == identification::Method::decoupled_partial_pose; }

  /// Effects and springs anew on these postures: the equations with those effects, and the compliances.
  std::pair<MethodRows, Vector6d> anew(const Weights& weights) const {
    const MethodRows here = rows_.at(refit_.steps(true_.targets, weights));
    return {here, solved(here, weights, decoupled(), own_.estimate.identifiable)};
  }

  identification::SubsetStudy study(bool wrist, PointJudge& at_wrist, PointJudge& at_targets) const {
    identification::SubsetStudy study;
    const identification::SubsetOptions& asked = options_.subsets;
    study.of = static_cast<int>(rows_.postures());
    study.size = asked.size > 0 ? asked.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
    if (study.size < 1 || study.size >= study.of) return study;
    constexpr std::uint64_t kMost = 1000;
    const std::uint64_t most = std::min({kMost, asked.sample, std::max<std::uint64_t>(asked.most_all, 1)});
    study.every_subset = numerics::subsetCount(study.of, study.size) <= most;
    numerics::forEachSubset(study.of, study.size, most, asked.seed, [&](const Weights& used) {
      const auto [rows, compliance] = anew(used);
      study.compliances.push_back(compliance);
      if (wrist) at_wrist.add(rows.wrist, compliance, used);
      at_targets.add(rows.targets, compliance, used);
    });
    const auto subsets = static_cast<double>(study.compliances.size());
    if (wrist) study.at_wrist = at_wrist.mean(subsets);
    study.at_targets = at_targets.mean(subsets);
    return study;
  }

  identification::PostureBootstrap bootstrap() const {
    identification::PostureBootstrap result;
    std::mt19937_64 random(options_.bootstrap.seed);
    const std::size_t n = rows_.postures();
    for (int draw = 0; draw < options_.bootstrap.draws; ++draw) {
      result.compliances.push_back(anew(numerics::drawWeights(random, n)).second);
    }
    return result;
  }

  const identification::IdentifyOptions& options_;
  const ExtendedModel& model_;
  identification::Method which_;
  const identification::MethodResult& own_;
  EffectRefit refit_;
  MovingRows rows_;
  MethodRows true_;
};

/// Displacements by case of the campaign with only the measurement's faults taken off.
void describeDisplacements(const campaign::Campaign& measured, ExtendedModel& model) {
  identification::Identification& with = model.with;
  const campaign::Campaign truth =
      withoutEffects(measured, model.effects, model.effects.parameters(), TakenOff::measurement);
  for (const identification::Method which :
       {identification::Method::decoupled_partial_pose, identification::Method::complete_pose,
        identification::Method::partial_pose}) {
    if (!with.of(which).available) continue;
    const identification::LoadedArm arm =
        identification::loadedArm(truth, with.of(which).geometry, with.frames.wrist, with.steps);
    const auto scaled = [](const std::vector<double>& now, const std::vector<double>& before, double share) {
      const double sum = std::accumulate(now.begin(), now.end(), 0.0);
      return sum > 0.0 ? share * std::accumulate(before.begin(), before.end(), 0.0) / sum : share;
    };
    std::vector<double> targets, wrist;
    for (const identification::LoadCase& one : arm.cases) {
      double sum = 0.0;
      for (const identification::TargetMove& move : one.targets) sum += move.displacement().norm();
      targets.push_back(sum / static_cast<double>(one.targets.size()));
    }
    for (const identification::WristMove& move : arm.wrist) wrist.push_back(move.displacement().norm());
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

void evaluateExtended(const campaign::Campaign& measured, const identification::IdentifyOptions& options,
                      ExtendedModel& model) {
  for (const identification::Method which : identification::kMethods) {
    if (!model.with.of(which).available) continue;
    MethodJudge(measured, options, model, which).fill(model.with.methods[static_cast<std::size_t>(which)]);
  }
  describeDisplacements(measured, model);
}

namespace {

using Rows = std::vector<identification::CaseEquations>;

bool alike(const Rows& a, const Rows& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].posture != b[i].posture || a[i].right.size() != b[i].right.size()) return false;
  }
  return true;
}

void subtract(const Rows& at, Rows& from) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    from[i].matrix -= at[i].matrix;
    from[i].right -= at[i].right;
  }
}

void add(const Rows& change, double step, Rows& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i].matrix += step * change[i].matrix;
    to[i].right += step * change[i].right;
  }
}

}  // namespace

MethodRows methodRows(const campaign::Campaign& campaign, const identification::Identification& result,
                      identification::Method method) {
  const identification::MethodResult& own = result.of(method);
  identification::LoadedArm arm = identification::loadedArm(campaign, own.geometry, result.frames.wrist, result.steps);
  // One settling with the compliances as they are: only the equations are wanted.
  identification::solveLoadedArm(arm, result.finite_deflection,
                                 [&](const identification::LoadedArm&) { return own.estimate.compliance; });
  MethodRows rows;
  rows.targets = identification::byPosture(identification::reflectorEquations(arm));
  rows.wrist = identification::byPosture(identification::wristPointEquations(arm));
  switch (method) {
    case identification::Method::complete_pose:
      for (const identification::CaseEquations& one : identification::poseEquations(arm, result.frames.tcp_in_flange))
        rows.solved.push_back(identification::normalised(one, result.characteristic_length.length));
      rows.solved = identification::byPosture(rows.solved);
      break;
    case identification::Method::partial_pose:
      rows.solved = rows.targets;
      break;
    case identification::Method::decoupled_partial_pose:
      rows.solved = rows.wrist;
      break;
  }
  return rows;
}

MovingRows::MovingRows(MethodRows at, std::vector<MethodRows> moved) : at_(std::move(at)), moved_(std::move(moved)) {
  for (MethodRows& one : moved_) {
    movable_ =
        movable_ && alike(at_.solved, one.solved) && alike(at_.targets, one.targets) && alike(at_.wrist, one.wrist);
    if (!movable_) return;
    subtract(at_.solved, one.solved);
    subtract(at_.targets, one.targets);
    subtract(at_.wrist, one.wrist);
  }
}

MethodRows MovingRows::at(const Eigen::VectorXd& steps) const {
  MethodRows rows = at_;
  for (std::size_t k = 0; movable_ && k < moved_.size(); ++k) {
    const double step = steps[static_cast<Eigen::Index>(k)];
    add(moved_[k].solved, step, rows.solved);
    add(moved_[k].targets, step, rows.targets);
    add(moved_[k].wrist, step, rows.wrist);
  }
  return rows;
}

}  // namespace stiffscope::extended_model
