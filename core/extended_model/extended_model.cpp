#include "core/extended_model/extended_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/extended_model/corrected_campaign.h"
#include "core/extended_model/declared.h"
#include "core/extended_model/effect_fit.h"
#include "core/extended_model/method_equations.h"
#include "core/identification/estimate.h"
#include "core/identification/remarks.h"
#include "core/identification/shown_first.h"
#include "core/identification/warnings.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

/// Judges the methods of `model.with` with the effects in the model: displacements are the machine's own, and on every
/// subset of postures (all up to a thousand, else a thousand drawn) effects and springs are fitted anew, the effects by
/// one linear step, the equations following them to first order. Fills shares, residuals, `subsets`, and the bootstrap
/// where it is asked for, of every available method, and the displacements by case.
void evaluateExtended(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                      ExtendedModel& model);

namespace {

/// The values alone: no subsets, no bootstrap, no outliers sought.
identification::IdentifyOptions valuesOnly(identification::IdentifyOptions options) {
  options.subsets.size = std::numeric_limits<int>::max();
  options.bootstrap.draws = 0;
  options.robust = false;
  return options;
}

/// To first order: d c = -G E S, G the method's solution of its equations A c + E theta = b.
void findSpread(const std::vector<CaseEffects>& cases, ExtendedModel& model) {
  EffectSpread& spread = model.spread;
  const Eigen::Index count = spread.parameters.cols();
  for (const identification::Method which : identification::kMethods) {
    auto& columns = spread.compliance[static_cast<std::size_t>(which)];
    columns.setZero(6, count);
    const identification::MethodResult& method = model.with.of(which);
    if (!method.available) continue;
    const MethodEquations equations = methodEquations(model.with, which, cases);
    const std::vector<double> all(equations.reflectors.size(), 1.0);
    const auto at = [&](const Eigen::VectorXd& steps) {
      return solvedCompliance(equations, which, method.estimate.identifiable, all, steps);
    };
    const Vector6d here = at(Eigen::VectorXd::Zero(count));
    for (Eigen::Index k = 0; k < count; ++k) columns.col(k) = at(Eigen::VectorXd::Unit(count, k)) - here;
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
  model.campaign = correctedFor(model.effects, campaign, left_out);
  identification::IdentifyOptions own = valuesOnly(options);
  own.robust = options.robust;
  model.with = identification::identify(model.campaign, own);
  model.with.left_out.insert(model.with.left_out.end(), left_out.begin(), left_out.end());
  model.spread.parameters = covarianceRoot(model.effects.covariance);
  const std::vector<CaseEffects> cases = caseEffects(model.effects, model.spread.parameters, model.with);
  findSpread(cases, model);
  addEffectsUncertainty(model);
  evaluateExtended(options, cases, model);
  model.with.shown_first = identification::methodShownFirst(model.with, options.papers_choice);
  model.with.cautions = identification::warningsOf(model.campaign, model.with);
  return model;
}

namespace {

/// The study's effects fitted to the whole day, and nothing where one of them cannot be.
EffectFit chosenEffects(const preparation::PreparedCampaign& prepared, const diagnosis::GapStudy& study) {
  EffectFit none;
  try {
    EffectFit chosen = fitEffects(prepared, chosenBy(study));
    if (chosen.free.empty() || chosen.shrink.high > 0.0) return chosen;
    none.notes.emplace_back(RemarkId::effects_do_not_help);
  } catch (const UnfitEffect& error) {
    none.notes.push_back(error.reason());
  }
  return none;
}

/// Gap and shrink as the diagnosis states them, of the study's own fit, the selection repeated inside the shrink. What
/// the nests put in is off the readings here and not there, so then the fit's own stand.
void describeAsDiagnosed(const diagnosis::GapStudy& study, EffectFit& chosen) {
  if (chosen.free.empty() || !study.given.empty()) return;
  const diagnosis::GapFit& fit = study.fit;
  const diagnosis::GapFit alone = diagnosis::withoutEffects(*study.input, study.start->state, fit);
  const diagnosis::StiffnessesAlone before =
      diagnosis::stiffnessesAlone(alone.data, std::vector<double>(alone.data.postures.size(), 1.0), alone.projection);
  chosen.gap = diagnosis::deflectionGap(alone, before, fit, diagnosis::allParameters(fit.nuisances, fit.set.effects));
  const diagnosis::DiagnoseOptions as_there;
  const diagnosis::HeldOutShrink held_out = diagnosis::heldOutShrinks(*study.input, alone, fit, study.allowed,
                                                                      {{true, {}}}, as_there.resamples, as_there.seed)
                                                .front();
  chosen.shrink = held_out.deflection;
  chosen.explained = held_out.explained;
}

/// More than noise in the residual is said, whatever its size; and that the sag's doubt is in the frames' uncertainty.
void cautionBeside(ExtendedModel& model) {
  if (model.with.frames.covariance.hidden.size() > 0) {
    for (Remark& one : model.with.cautions) {
      if (one.is(identification::RemarkId::sag_in_sweeps))
        one = Remark(identification::RemarkId::sag_in_sweeps_weighed, model.with.frames.largest_sag);
    }
  }
  if (model.residualIsNoise()) return;
  for (const Remark& one : model.with.cautions) {
    if (one.is(identification::RemarkId::residual_above_noise)) return;
  }
  model.with.cautions.emplace_back(RemarkId::residual_beyond_noise, model.leftOver(), model.hidden->lack_of_fit,
                                   model.hidden->unexplained);
}

/// Whether joint springs come out negative one and all: then no model of the machine is to be looked for.
bool contradicted(const identification::Identification& springs) {
  bool any = false;
  for (const identification::MethodResult& method : springs.methods) {
    if (!method.available) continue;
    for (int j = 0; j < 6; ++j) {
      if (!method.estimate.identifiable[static_cast<std::size_t>(j)]) continue;
      if (method.estimate.compliance[j] > 0.0) return false;
      any = true;
    }
  }
  return any;
}

}  // namespace

ExtendedModel supportedModel(const preparation::PreparedCampaign& prepared, const campaign::Campaign& campaign,
                             const identification::IdentifyOptions& options) {
  const bool thinned = diagnosis::isLong(prepared.campaign);
  std::optional<preparation::PreparedCampaign> spread;
  if (thinned) spread = diagnosis::spreadForDiagnosis(prepared);
  auto whole = std::make_unique<const diagnosis::GapStudy>(diagnosis::studyGap(spread ? *spread : prepared));
  const diagnosis::GapStudy& study = *whole;
  if (!study.usable()) {
    EffectFit none;
    none.notes.emplace_back(RemarkId::diagnosis_has_no_gap, study.start->reason);
    return extendModel(campaign, std::move(none), options);
  }
  EffectFit chosen = chosenEffects(prepared, study);
  describeAsDiagnosed(study, chosen);
  ExtendedModel model = extendModel(campaign, std::move(chosen), options);
  if (contradicted(model.without)) {
    EffectFit none;
    none.notes.emplace_back(RemarkId::springs_contradicted);
    return extendModel(campaign, std::move(none), options);
  }
  const Declared declared = declaredOf(model.campaign, model.with, options);
  model.study = std::move(whole);
  if (!thinned) {
    model.hidden =
        weighHiddenEffects(study, model.effects, model.campaign, model.with, model.without, declared, model.with);
  } else {
    std::vector<identification::LeftOutPosture> left_out;
    const EffectFit own = chosenEffects(*spread, study);
    campaign::Campaign seen = own.free.empty() ? spread->campaign : correctedFor(own, spread->campaign, left_out);
    model.hidden = weighHiddenEffects(study, own, seen, identification::identify(seen, valuesOnly(options)),
                                      model.without, declared, model.with);
  }
  // What is known from elsewhere is held against the intervals that are stated.
  if (!model.campaign.known_stiffness.empty())
    model.with.cautions = identification::warningsOf(model.campaign, model.with);
  cautionBeside(model);
  return model;
}

void stateStiffnesses(const ExtendedModel& model, diagnosis::Diagnosis& diagnosis) {
  const identification::Method which = identification::bestMethod(model.with);
  if (!model.with.of(which).available || !model.without.of(which).available) return;
  const identification::StiffnessEstimate& estimate = model.with.of(which).estimate;
  const identification::StiffnessEstimate& alone = model.without.of(which).estimate;
  diagnosis::StatedStiffness& stated = diagnosis.stated.emplace();
  stated.method = which;
  for (int j = 0; j < 6; ++j) {
    const auto at = static_cast<std::size_t>(j);
    diagnosis.identifiable[at] = estimate.identifiable[at];
    if (!estimate.identifiable[at]) continue;
    diagnosis.stiffness_before[j] = alone.stiffness(j);
    diagnosis.stiffness_after[j] = estimate.stiffness(j);
    diagnosis.stiffness_after_sd[j] = estimate.stiffnessSd(j);
    stated.expanded[j] = identification::expandedUncertainty(estimate, j);
    stated.interval[at] = identification::stiffnessInterval(estimate, j);
  }
}

namespace {

using numerics::Weights;  // of the postures of the campaign

/// Sum over points, three numbers each, of their displacement.
double pointSum(const Eigen::VectorXd& displacement) {
  double sum = 0.0;
  for (Eigen::Index at = 0; at < displacement.size(); at += 3) sum += displacement.segment<3>(at).norm();
  return sum;
}

/// Of a posture's points what the model leaves of their displacement.
double leftOf(const ExtendedEquations& one, const Eigen::VectorXd& steps, const Vector6d& compliance) {
  return pointSum(one.rightAt(steps) - one.springs.matrix * compliance);
}

/// One kind of point, judged over the subsets.
class PointJudge {
 public:
  /// `equations` and displacement by posture.
  PointJudge(const std::vector<ExtendedEquations>& equations, std::vector<double> displacement)
      : equations_(equations), displacement_(std::move(displacement)), count_(displacement_.size(), 0) {
    sum_.left_held_out.resize(displacement_.size(), 0.0);
  }

  void add(const Eigen::VectorXd& steps, const Vector6d& compliance, const Weights& used) {
    std::array<double, 2> left{}, whole{};
    for (std::size_t p = 0; p < equations_.size(); ++p) {
      const auto side = static_cast<std::size_t>(used[p] != 0.0);
      const double own = leftOf(equations_[p], steps, compliance);
      left[side] += own;
      whole[side] += displacement_[p];
      if (side == 0) sum_.left_held_out[p] += own, ++count_[p];
    }
    sum_.compensated.used += 1.0 - left[1] / whole[1];
    sum_.held_out.push_back(1.0 - left[0] / whole[0]);
    sum_.compensated.held_out += sum_.held_out.back();
    sum_.compensated.all += 1.0 - (left[0] + left[1]) / (whole[0] + whole[1]);
  }

  double allPostures(const Eigen::VectorXd& steps, const Vector6d& compliance) const {
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
  const std::vector<ExtendedEquations>& equations_;
  std::vector<double> displacement_;
  std::vector<std::uint64_t> count_;
  identification::SubsetJudgement sum_;
};

/// The effects' parameters fitted on postures with weights, as steps along the columns of the spread.
class EffectRefit {
 public:
  EffectRefit(const ExtendedModel& model, const std::vector<ExtendedEquations>& equations)
      : effects_(model.effects), from_parameters_(pseudoInverse(model.spread.parameters)) {
    std::map<int, std::size_t> at;
    for (std::size_t g = 0; g < effects_.fit.data.postures.size(); ++g) at[effects_.fit.data.postures[g].pose] = g;
    for (const ExtendedEquations& one : equations) in_fit_.push_back(at.at(one.springs.posture));
  }

  /// `weights` of the method's postures; others do not take part.
  Eigen::VectorXd steps(const Weights& weights) const {
    Weights own(effects_.fit.data.postures.size(), 0.0);
    for (std::size_t p = 0; p < weights.size(); ++p) own[in_fit_[p]] = weights[p];
    const Eigen::VectorXd change = parametersFrom(effects_, own) - effects_.parameters();
    return from_parameters_ * change(effects_.free);
  }

 private:
  const EffectFit& effects_;
  Eigen::MatrixXd from_parameters_;
  std::vector<std::size_t> in_fit_;  ///< the fit's posture of each of the method's
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
              const MethodEquations& equations)
      : options_(options),
        model_(model),
        which_(which),
        own_(model.with.of(which)),
        equations_(equations),
        refit_(model, equations.reflectors) {}

  void fill(const MachineDisplacement& machine, identification::MethodResult& out) const {
    out.subsets = judge(machine, own_.estimate.compliance, out);
    out.bootstrap = bootstrap();
  }

  /// Complete Pose at the length of its equations.
  void fill(const MachineDisplacement& machine, identification::LengthSensitivity& out) const {
    const std::vector<double> all(equations_.reflectors.size(), 1.0);
    out.compliance = solvedCompliance(equations_, which_, own_.estimate.identifiable, all, noSteps());
    out.subsets = judge(machine, out.compliance, out).compliances.size();
  }

 private:
  Eigen::VectorXd noSteps() const { return Eigen::VectorXd::Zero(model_.spread.parameters.cols()); }

  /// Fills `at_wrist` and `at_targets` of `out`.
  template <class Out>
  identification::SubsetStudy judge(const MachineDisplacement& machine, const Vector6d& compliance, Out& out) const {
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

  /// Effects and springs anew on these postures: the steps of the effects, and the compliances.
  std::pair<Eigen::VectorXd, Vector6d> anew(const Weights& weights) const {
    Eigen::VectorXd steps = refit_.steps(weights);
    const Vector6d compliance = solvedCompliance(equations_, which_, own_.estimate.identifiable, weights, steps);
    return {std::move(steps), compliance};
  }

  identification::SubsetStudy study(bool wrist, PointJudge& at_wrist, PointJudge& at_targets) const {
    identification::SubsetStudy study;
    const identification::SubsetOptions& asked = options_.subsets;
    study.of = static_cast<int>(equations_.reflectors.size());
    study.size = asked.size > 0 ? asked.size : static_cast<int>(std::lround(study.of * 10.0 / 19.0));
    if (study.size < 1 || study.size >= study.of) return study;
    constexpr std::uint64_t kMost = 1000;
    const std::uint64_t most = std::min({kMost, asked.sample, std::max<std::uint64_t>(asked.most_all, 1)});
    study.every_subset = numerics::subsetCount(study.of, study.size) <= most;
    numerics::forEachSubset(study.of, study.size, most, asked.seed, [&](const Weights& used) {
      const auto [steps, compliance] = anew(used);
      study.compliances.push_back(compliance);
      if (wrist) at_wrist.add(steps, compliance, used);
      at_targets.add(steps, compliance, used);
    });
    const auto subsets = static_cast<double>(study.compliances.size());
    if (wrist) study.at_wrist = at_wrist.mean(subsets);
    study.at_targets = at_targets.mean(subsets);
    return study;
  }

  identification::PostureBootstrap bootstrap() const {
    identification::PostureBootstrap result;
    std::mt19937_64 random(options_.bootstrap.seed);
    const std::size_t n = equations_.reflectors.size();
    for (int draw = 0; draw < options_.bootstrap.draws; ++draw) {
      result.compliances.push_back(anew(numerics::drawWeights(random, n)).second);
    }
    return result;
  }

  const identification::IdentifyOptions& options_;
  const ExtendedModel& model_;
  identification::Method which_;
  const identification::MethodResult& own_;
  const MethodEquations& equations_;
  EffectRefit refit_;
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

/// Complete Pose against its length, as the methods are judged, on fewer subsets.
void judgeLengths(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                  const MachineDisplacement& machine, ExtendedModel& model) {
  identification::Identification& with = model.with;
  if (!with.of(identification::Method::complete_pose).available) return;
  identification::IdentifyOptions few = options;
  constexpr std::uint64_t kMost = 50;  // each fits springs and effects anew
  few.subsets.sample = std::min(kMost, few.subsets.sample);
  std::vector<identification::LengthSensitivity*> lengths;
  for (identification::LengthSensitivity& one : with.length_sensitivity) lengths.push_back(&one);
  if (with.residual_length) lengths.push_back(&*with.residual_length);
  for (identification::LengthSensitivity* one : lengths) {
    const MethodEquations equations = methodEquations(with, identification::Method::complete_pose, cases, one->length);
    if (equations.reflectors.empty()) return;
    MethodJudge(few, model, identification::Method::complete_pose, equations).fill(machine, *one);
  }
}

}  // namespace

void evaluateExtended(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                      ExtendedModel& model) {
  const MachineDisplacement machine = machineDisplacement(model.with, cases);
  for (const identification::Method which : identification::kMethods) {
    if (!model.with.of(which).available) continue;
    const MethodEquations equations = methodEquations(model.with, which, cases);
    if (equations.reflectors.empty()) continue;
    MethodJudge(options, model, which, equations).fill(machine, model.with.methods[static_cast<std::size_t>(which)]);
  }
  judgeLengths(options, cases, machine, model);
  describeDisplacements(machine, model.with);
}

}  // namespace stiffscope::extended_model
