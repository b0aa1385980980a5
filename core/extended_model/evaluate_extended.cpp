#include "core/extended_model/extend_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include "core/extended_model/effect_fit.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

namespace {

using numerics::Weights;  // of the postures of the campaign

/// Sum over points, three numbers each, of their displacement.
double pointSum(const Eigen::VectorXd& displacement) {
  double sum = 0.0;
  for (Eigen::Index at = 0; at < displacement.size(); at += 3) sum += displacement.segment<3>(at).norm();
  return sum;
}

/// Of a posture's points what the model leaves of their displacement.
double leftOf(const ExtendedEquations& one, const Eigen::VectorXd& steps, const JointVector& compliance) {
  return pointSum(one.rightAt(steps) - one.springs.matrix * compliance);
}

/// Effects and springs fitted anew on some postures.
struct Refit {
  Weights used;
  Eigen::VectorXd steps;
  JointVector compliance;
};

/// leftOf for each of some refits at once, whose steps and compliances stand in columns.
Eigen::VectorXd leftOfAll(const ExtendedEquations& one, const Eigen::MatrixXd& steps,
                          const Eigen::MatrixXd& compliances) {
  Eigen::MatrixXd left = -one.by_steps * steps;
  left.noalias() -= one.springs.matrix * compliances;
  left.colwise() += one.springs.right;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(left.cols());
  for (Eigen::Index at = 0; at < left.rows(); at += 3) sums += left.middleRows<3>(at).colwise().norm().transpose();
  return sums;
}

/// One kind of point, judged over the subsets.
class PointJudge {
 public:
  /// `equations` and displacement by posture.
  PointJudge(const std::vector<ExtendedEquations>& equations, std::vector<double> displacement)
      : equations_(equations), displacement_(std::move(displacement)), count_(displacement_.size(), 0) {
    sum_.left_held_out.resize(displacement_.size(), 0.0);
  }

  void add(const std::vector<Refit>& refits) {
    if (refits.empty()) return;
    const auto count = static_cast<Eigen::Index>(refits.size());
    Eigen::MatrixXd steps(refits.front().steps.size(), count), compliances(refits.front().compliance.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      steps.col(k) = refits[static_cast<std::size_t>(k)].steps;
      compliances.col(k) = refits[static_cast<std::size_t>(k)].compliance;
    }
    Eigen::MatrixXd left(count, static_cast<Eigen::Index>(equations_.size()));
    numerics::smallWorkOnAllCores(equations_.size(), [&](std::size_t p) {
      left.col(static_cast<Eigen::Index>(p)) = leftOfAll(equations_[p], steps, compliances);
    });
    for (Eigen::Index k = 0; k < count; ++k) add(left.row(k), refits[static_cast<std::size_t>(k)].used);
  }

  double allPostures(const Eigen::VectorXd& steps, const JointVector& compliance) const {
    double left = 0.0;
    for (const ExtendedEquations& one : equations_) left += leftOf(one, steps, compliance);
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
  /// `own`: what a refit on the postures `used` leaves, by posture.
  void add(const Eigen::RowVectorXd& own, const Weights& used) {
    std::array<double, 2> left{}, whole{};
    for (std::size_t p = 0; p < equations_.size(); ++p) {
      const auto side = static_cast<std::size_t>(used[p] != 0.0);
      const double here = own[static_cast<Eigen::Index>(p)];
      left[side] += here;
      whole[side] += displacement_[p];
      if (side == 0) sum_.left_held_out[p] += here, ++count_[p];
    }
    sum_.compensated.used += 1.0 - left[1] / whole[1];
    sum_.held_out.push_back(1.0 - left[0] / whole[0]);
    sum_.compensated.held_out += sum_.held_out.back();
    sum_.compensated.all += 1.0 - (left[0] + left[1]) / (whole[0] + whole[1]);
  }

  const std::vector<ExtendedEquations>& equations_;
  std::vector<double> displacement_;
  std::vector<std::uint64_t> count_;
  identification::SubsetJudgement sum_;
};

/// The effects' parameters fitted on postures with weights, as steps along the columns of the spread. The subsets are
/// the same for every method and length, so each is fitted once.
class EffectRefits {
 public:
  explicit EffectRefits(const ExtendedModel& model)
      : effects_(model.effects), from_parameters_(pseudoInverse(model.spread.parameters)) {}

  /// Of each sample, which has weights of the postures of `equations`; others do not take part.
  std::vector<Eigen::VectorXd> steps(const std::vector<ExtendedEquations>& equations,
                                     const std::vector<Weights>& samples) {
    std::vector<std::pair<std::size_t, std::size_t>> in_fit;  // place in `equations` and in the fit
    for (std::size_t p = 0; p < equations.size(); ++p) {
      const std::optional<std::size_t>& fitted = effects_.day.at(equations[p].springs.posture).in_fit;
      if (fitted) in_fit.emplace_back(p, *fitted);
    }
    std::vector<Known::iterator> all, fresh;
    for (const Weights& weights : samples) {
      Weights own(effects_.fit.data->postures.size(), 0.0);
      for (const auto& [from, to] : in_fit) own[to] = weights[from];
      const auto [known, is_fresh] = known_.try_emplace(std::move(own));
      all.push_back(known);
      if (is_fresh) fresh.push_back(known);
    }
    numerics::onAllCores(fresh.size(), [&](std::size_t i) {
      const Eigen::VectorXd change = parametersFrom(effects_, fresh[i]->first) - effects_.parameters();
      fresh[i]->second = from_parameters_ * change(effects_.free);
    });
    std::vector<Eigen::VectorXd> steps;
    for (const Known::iterator& one : all) steps.push_back(one->second);
    return steps;
  }

 private:
  using Known = std::map<Weights, Eigen::VectorXd>;  // by weights of the fit's postures

  const EffectFit& effects_;
  Eigen::MatrixXd from_parameters_;
  Known known_;
};

/// Displacement of the machine itself: with faults of the measurement corrected, with what its effects add.
struct MachineDisplacement {
  std::vector<double> reflectors, wrist;  ///< sums over the points of a case, m; `wrist` empty where not measured
};

MachineDisplacement machineDisplacement(const identification::Identification& with,
                                        const std::vector<CaseEffects>& cases) {
  MachineDisplacement sums;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Eigen::VectorXd moves = cases[i].by_machine;
    Eigen::Index row = 0;
    for (const identification::TargetMove& move : with.cases[i].targets) {
      moves.segment<3>(row) += move.displacement();
      row += 3;
    }
    sums.reflectors.push_back(pointSum(moves));
    if (!with.wrist.empty()) sums.wrist.push_back((with.wrist[i].displacement() + cases[i].wrist_machine).norm());
  }
  return sums;
}

/// Values of cases summed by posture.
std::vector<double> byPosture(const std::vector<identification::LoadCase>& cases, const std::vector<double>& values) {
  std::vector<double> sums;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || cases[i].pose != cases[i - 1].pose) sums.push_back(0.0);
    sums.back() += values[i];
  }
  return sums;
}

class MethodJudge {
 public:
  MethodJudge(const identification::IdentifyOptions& options, const ExtendedModel& model, identification::Method which,
              const MethodEquations& equations, EffectRefits& refits)
      : options_(options),
        model_(model),
        which_(which),
        own_(model.with.of(which)),
        equations_(equations),
        refits_(refits) {}

  void fill(const MachineDisplacement& machine, identification::MethodResult& out) const {
    out.subsets = judge(machine, own_.estimate.compliance, out);
    out.bootstrap = bootstrap();
  }

  /// Complete Pose at another length than its own.
  void fill(const MachineDisplacement& machine, identification::LengthSensitivity& out) const {
    const std::vector<double> all(equations_.reflectors.size(), 1.0);
    out.compliance = solvedCompliance(equations_, which_, own_.estimate.identifiable, all, noSteps());
    out.subsets = judge(machine, out.compliance, out).compliances.size();
  }

 private:
  Eigen::VectorXd noSteps() const { return Eigen::VectorXd::Zero(model_.spread.parameters.cols()); }

  /// Fills `at_wrist` and `at_targets` of `out`.
  template <class Out>
  identification::SubsetStudy judge(const MachineDisplacement& machine, const JointVector& compliance, Out& out) const {
    PointJudge at_targets(equations_.reflectors, byPosture(model_.with.cases, machine.reflectors));
    PointJudge at_wrist(equations_.wrist, byPosture(model_.with.cases, machine.wrist));
    const bool wrist = !equations_.wrist.empty();
    identification::SubsetStudy subsets = study(wrist, at_wrist, at_targets);
    const auto judged = [&](const PointJudge& judge, const identification::SubsetJudgement& own) {
      return identification::Compensation{judge.allPostures(noSteps(), compliance), own.compensated,
                                          identification::meanOverSubsets(own.held_out).sd};
    };
    if (wrist) out.at_wrist = judged(at_wrist, subsets.at_wrist);
    out.at_targets = judged(at_targets, subsets.at_targets);
    return subsets;
  }

  /// Effects and springs anew on each of some samples of the postures.
  std::vector<Refit> anew(std::vector<Weights> samples) const {
    std::vector<Eigen::VectorXd> steps = refits_.steps(equations_.reflectors, samples);
    std::vector<Refit> refits(samples.size());
    numerics::onAllCores(samples.size(), [&](std::size_t i) {
      const JointVector compliance =
          solvedCompliance(equations_, which_, own_.estimate.identifiable, samples[i], steps[i]);
      refits[i] = {std::move(samples[i]), std::move(steps[i]), compliance};
    });
    return refits;
  }

  identification::SubsetStudy study(bool wrist, PointJudge& at_wrist, PointJudge& at_targets) const {
    identification::SubsetStudy study;
    const identification::SubsetOptions& asked = options_.subsets;
    study.of = static_cast<int>(equations_.reflectors.size());
    study.size = asked.size > 0 ? asked.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
    if (study.size < 1 || study.size >= study.of) return study;
    constexpr std::uint64_t kMost = 1000, kWork = 400'000, kFewest = 50;  // work: postures judged in all
    const std::uint64_t affordable = std::clamp(kWork / static_cast<std::uint64_t>(study.of), kFewest, kMost);
    const std::uint64_t most = std::min({affordable, asked.sample, std::max<std::uint64_t>(asked.most_all, 1)});
    study.every_subset = numerics::subsetCount(study.of, study.size) <= most;
    std::vector<Weights> samples;
    numerics::forEachSubset(study.of, study.size, most, asked.seed,
                            [&](const Weights& used) { samples.push_back(used); });
    const std::vector<Refit> refits = anew(std::move(samples));
    for (const Refit& refit : refits) study.compliances.push_back(refit.compliance);
    if (wrist) at_wrist.add(refits);
    at_targets.add(refits);
    const auto subsets = static_cast<double>(study.compliances.size());
    if (wrist) study.at_wrist = at_wrist.mean(subsets);
    study.at_targets = at_targets.mean(subsets);
    return study;
  }

  identification::PostureBootstrap bootstrap() const {
    identification::PostureBootstrap result;
    std::mt19937_64 random(options_.bootstrap.seed);
    const std::size_t n = equations_.reflectors.size();
    std::vector<Weights> samples;
    for (int draw = 0; draw < options_.bootstrap.draws; ++draw) samples.push_back(numerics::drawWeights(random, n));
    for (const Refit& refit : anew(std::move(samples))) result.compliances.push_back(refit.compliance);
    return result;
  }

  const identification::IdentifyOptions& options_;
  const ExtendedModel& model_;
  identification::Method which_;
  const identification::MethodResult& own_;
  const MethodEquations& equations_;
  EffectRefits& refits_;
};

/// Displacements by case, and what noise makes of them, of the machine itself.
void describeDisplacements(const MachineDisplacement& machine, identification::Identification& with) {
  const auto scaled = [](const std::vector<double>& now, const std::vector<double>& before, double share) {
    const double sum = std::accumulate(now.begin(), now.end(), 0.0);
    return sum > 0.0 ? share * std::accumulate(before.begin(), before.end(), 0.0) / sum : share;
  };
  std::vector<double> mean = machine.reflectors;
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] /= static_cast<double>(with.cases[i].targets.size());
  if (with.noise) with.noise->at_targets = scaled(mean, with.target_displacement, with.noise->at_targets);
  with.target_displacement = std::move(mean);
  if (machine.wrist.size() != with.wrist_displacement.size()) return;
  if (with.noise && with.noise->at_wrist)
    with.noise->at_wrist = scaled(machine.wrist, with.wrist_displacement, *with.noise->at_wrist);
  with.wrist_displacement = machine.wrist;
}

/// Complete Pose, with its equations, against its length, as the methods are judged, on fewer subsets.
void judgeLengths(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                  const MachineDisplacement& machine, MethodEquations equations, EffectRefits& refits,
                  ExtendedModel& model) {
  identification::Identification& with = model.with;
  identification::IdentifyOptions few = options;
  constexpr std::uint64_t kMost = 50;  // each fits springs and effects anew
  few.subsets.sample = std::min(kMost, few.subsets.sample);
  std::vector<identification::LengthSensitivity*> lengths;
  for (identification::LengthSensitivity& one : with.length_sensitivity) lengths.push_back(&one);
  if (with.residual_length) lengths.push_back(&*with.residual_length);
  for (identification::LengthSensitivity* one : lengths) {
    equations.pose = poseNormals(with, cases, one->length);
    MethodJudge(few, model, identification::Method::complete_pose, equations, refits).fill(machine, *one);
  }
}

}  // namespace

void evaluateExtended(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                      ExtendedModel& model) {
  const MachineDisplacement machine = machineDisplacement(model.with, cases);
  EffectRefits refits(model);
  const Eigen::Index steps = model.spread.parameters.cols();
  for (const identification::Method which : identification::kMethods) {
    identification::MethodResult& method = model.with.methods[static_cast<std::size_t>(which)];
    auto& spread = model.spread.compliance[static_cast<std::size_t>(which)];
    spread.setZero(model.campaign.robot.joints(), steps);
    if (!method.available) continue;
    MethodEquations equations = methodEquations(model.with, which, cases);
    // To first order: d c = -G E S, G the method's solution of its equations A c + E theta = b.
    spread = complianceBySteps(equations, which, method.estimate.identifiable, steps);
    if (equations.reflectors.empty()) continue;
    MethodJudge(options, model, which, equations, refits).fill(machine, method);
    if (which == identification::Method::complete_pose)
      judgeLengths(options, cases, machine, std::move(equations), refits, model);
  }
  describeDisplacements(machine, model.with);
}

}  // namespace stiffscope::extended_model
