#include "core/extended_model/hidden_effects.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/effects/gravity_equilibrium.h"
#include "core/extended_model/method_equations.h"
#include "core/identification/estimate.h"
#include "core/numerics/random.h"
#include "core/numerics/resampling.h"

namespace stiffscope::extended_model {

namespace {

using identification::Method;
using identification::StiffnessEstimate;

/// Calls visit(row) for every reading of the sweeps, in their order.
template <class Visit>
void forEachReading(const campaign::Campaign& campaign, const Visit& visit) {
  const auto ofTable = [&](const auto& table) {
    if (!table) return;
    for (const auto& row : table->rows) visit(row);
  };
  ofTable(campaign.circle_sweeps);
  ofTable(campaign.wrist_sweep);
}

/// Columns of the effects at the sweeps' readings, three rows a reading, in the sweeps' frame; m per unit.
Eigen::MatrixXd columnsAtSweeps(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                const campaign::Campaign& campaign) {
  const diagnosis::SystemState& state = study.fit.state;
  const diagnosis::GapLayout& layout = study.fit.data->layout;
  const Eigen::Matrix3d sweeps_from_r0 = state.r0_from_sweeps.linear().transpose();
  std::vector<Eigen::MatrixXd> rows;
  effects::ArmState rest;
  forEachReading(campaign, [&](const auto& row) {
    const auto standsThere = [&](double carriage) { return rest.carriage == carriage || std::isnan(carriage); };
    if (rows.empty() || rest.q != row.q || !standsThere(row.carriage))
      rest = effects::gravityEquilibrium(state.geometry, state.at, row.q, row.carriage);
    rest.pose = -1;
    rest.time_s = row.time_s;
    rest.targets = {row.target};
    rest.points = {state.r0_from_sweeps * row.point};
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, layout.end - layout.effects);
    for (const std::size_t m : columns.models) {
      const effects::EffectModel& model = study.input->models[m];
      all.middleCols(layout.model_at[m] - layout.effects, static_cast<Eigen::Index>(model.parameters())) =
          model.columns(state.at, {rest}, 0);
    }
    rows.push_back(sweeps_from_r0 * all(Eigen::all, columns.parameters));
  });
  Eigen::MatrixXd together(3 * static_cast<Eigen::Index>(rows.size()), columns.parameters.size());
  for (std::size_t i = 0; i < rows.size(); ++i) together.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = rows[i];
  return together;
}

/// How draws of effects' parameters move what the sweeps give: FramesCovariance's numbers, a draw each column. The
/// sweeps are read unloaded, so that effects act through the own weight: parameter k off by t_k leaves -X_k t_k in
/// readings that were corrected for its fitted size, X_k the effect's column there, and the compliances by which the
/// sag is taken off follow it by `compliance_off`. To first order, by one difference of the whole measurement for each
/// parameter.
///
/// `off`: theta - theta_fit, rows as `columns.parameters`; `compliance_off`: of the method by which the sag was taken
/// off, at `compliance`. `campaign`: the corrected day that `frames` was measured from. No columns where no sag was
/// taken off.
Eigen::MatrixXd framesByEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                const Eigen::MatrixXd& off, const Eigen::MatrixXd& compliance_off,
                                const campaign::Campaign& campaign, const frames::Frames& frames,
                                const JointVector& compliance) {
  if (!frames.sag_removed || !frames.arm.points_placed || !study.input->sweeps) return {};
  const Eigen::MatrixXd at_sweeps = columnsAtSweeps(study, columns, campaign);
  const frames::RigidPoints rigid = frames::rigidPoints(campaign, frames::sagOf(frames, compliance));
  const Eigen::VectorXd here = frames::framesChange(campaign, rigid, frames);
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(here.size(), off.cols());
  for (Eigen::Index k = 0; k < off.rows(); ++k) {
    const double size = std::sqrt(off.row(k).squaredNorm() / static_cast<double>(off.cols()));
    if (size == 0.0 || at_sweeps.col(k).isZero(0.0)) continue;
    // The sag is that of the joint angles, whatever was read there.
    frames::RigidPoints shifted = rigid;
    Eigen::Index row = 0;
    for (std::vector<Eigen::Vector3d>* points : {&shifted.circle_sweeps, &shifted.wrist_sweep}) {
      for (Eigen::Vector3d& point : *points) {
        point -= size * at_sweeps.col(k).segment<3>(row);
        row += 3;
      }
    }
    moved += (frames::framesChange(campaign, shifted, frames) - here) * (off.row(k) / size);
  }
  for (Eigen::Index j = 0; j < compliance.size(); ++j) {
    const double size = std::sqrt(compliance_off.row(j).squaredNorm() / static_cast<double>(compliance_off.cols()));
    if (size == 0.0) continue;
    JointVector more = compliance;
    more[j] += size;
    const frames::RigidPoints points = frames::rigidPoints(campaign, frames::sagOf(frames, more));
    const Eigen::VectorXd change = frames::framesChange(campaign, points, frames) - here;
    moved += change * (compliance_off.row(j) / size);
  }
  return moved;
}

/// One model for each effect that the campaign can show: the chosen one, else the first.
std::vector<std::size_t> modelOfEach(const diagnosis::GapStudy& study) {
  std::map<effects::Effect, std::size_t> model_of;
  const std::vector<effects::EffectModel>& models = study.input->models;
  for (const diagnosis::ChosenModel& one : study.fit.set.models) model_of.emplace(models[one.model].effect, one.model);
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (study.allowed[m]) model_of.emplace(models[m].effect, m);
  }
  std::vector<std::size_t> chosen;
  for (const auto& [effect, model] : model_of) chosen.push_back(model);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// What was fitted of a model of the study; zero where it was not.
Eigen::VectorXd fittedOf(const effects::EffectModel& model, const EffectFit& fitted) {
  if (fitted.input) {
    for (const diagnosis::ChosenModel& one : fitted.fit.set.models) {
      const effects::EffectModel& own = fitted.input->models[one.model];
      if (own.effect == model.effect && own.shape == model.shape) return fitted.parametersOf(one);
    }
  }
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.parameters()));
}

/// Standard uncertainty of an effect's parameters that is declared; 0: none is.
double declaredSd(effects::Effect effect, const Declared& declared) {
  if (effect == effects::Effect::load_cell_misalignment) return declared.cell_angle_sd;
  if (effect == effects::Effect::load_point_error) return declared.cell_point_sd;
  return 0.0;
}

HiddenDraws hiddenDraws(const diagnosis::GapStudy& study, const EffectFit& fitted, const Declared& declared) {
  const diagnosis::GapLayout& layout = study.fit.data->layout;
  const diagnosis::Projection& projection = study.fit.projection;
  HiddenDraws hidden;
  EffectEvidence evidence;
  std::vector<double> bound, at_fit;
  std::size_t scales = 0;
  hidden.columns.models = modelOfEach(study);
  for (std::size_t g = 0; g < hidden.columns.models.size(); ++g) {
    const std::size_t m = hidden.columns.models[g];
    const effects::EffectModel& model = study.input->models[m];
    const Eigen::VectorXd own = fittedOf(model, fitted);
    Eigen::Index at = layout.model_at[m] - layout.effects, of_own = 0;
    std::map<int, std::size_t> shared;
    for (const effects::EffectPart& part : model.parts) {
      for (std::size_t k = 0; k < part.most.size(); ++k) {
        if (projection.before[at] > 0.0) {
          const auto [of_alike, first] = shared.try_emplace(part.alike, scales);
          const bool own_scale = part.alike == 0 || first;
          evidence.scale.push_back(own_scale ? scales++ : of_alike->second);
          hidden.columns.parameters.push_back(at);
          hidden.effect.push_back(model.effect);
          hidden.named.push_back(
              {model.effect, effects::parameterName(part, k), effects::parameterUnit(part, k), own[of_own]});
          const double sd = declaredSd(model.effect, declared);
          hidden.declared.push_back(sd > 0.0);
          evidence.known_sd.push_back(sd / part.most[k]);
          evidence.group.push_back(g);
          evidence.positive.push_back(part.positive);
          bound.push_back(part.most[k]);
          at_fit.push_back(own[of_own]);
        }
        ++at, ++of_own;
      }
    }
  }
  const Eigen::VectorXd scale = Eigen::VectorXd::Map(bound.data(), static_cast<Eigen::Index>(bound.size()));
  const Eigen::VectorXd from = Eigen::VectorXd::Map(at_fit.data(), scale.size());
  // What no effect explains counts as noise.
  const double noise = diagnosis::varianceFactor(study.fit);
  const std::vector<Eigen::Index>& kept = hidden.columns.parameters;
  evidence.normal = scale.asDiagonal() * projection.matrix(kept, kept) * scale.asDiagonal() / noise;
  evidence.right = scale.cwiseProduct(projection.right(kept).eval()) / noise;
  hidden.off = (scale.asDiagonal() * drawEffects(evidence)).colwise() - from;
  return hidden;
}

/// -H: how a method's compliances follow each parameter.
JointsByColumn gains(const std::vector<CaseEffects>& cases, const identification::Identification& seen, Method which,
                     Eigen::Index parameters) {
  const MethodEquations equations = methodEquations(seen, which, cases);
  if (equations.reflectors.empty()) return {};
  return complianceBySteps(equations, which, seen.of(which).estimate.identifiable, parameters);
}

bool allPositive(const JointVector& compliance, const robot::JointMask& identifiable) {
  for (Eigen::Index j = 0; j < compliance.size(); ++j) {
    if (identifiable[static_cast<std::size_t>(j)] && compliance[j] <= 0.0) return false;
  }
  return true;
}

/// Columns of draws with no negative stiffness; all where hardly one is without.
std::vector<Eigen::Index> possibleDraws(const StiffnessEstimate& estimate, const Eigen::MatrixXd& moved) {
  std::vector<Eigen::Index> kept, all;
  for (Eigen::Index d = 0; d < moved.cols(); ++d) {
    all.push_back(d);
    if (allPositive(estimate.compliance + moved.col(d), estimate.identifiable)) kept.push_back(d);
  }
  constexpr std::size_t kFew = 20;
  return kept.size() < kFew ? all : kept;
}

/// HiddenEffects::to_possible, of a method whose estimate has a negative stiffness.
Eigen::VectorXd toPossible(const HiddenDraws& hidden, const JointsByColumn& gain, const StiffnessEstimate& estimate,
                           const std::vector<effects::Effect>& in_model) {
  Eigen::MatrixXd off = hidden.off;
  Eigen::VectorXd to_nothing = Eigen::VectorXd::Zero(off.rows());
  for (Eigen::Index k = 0; k < off.rows(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (std::find(in_model.begin(), in_model.end(), hidden.effect[at]) == in_model.end()) {
      off.row(k).setZero();
    } else {
      to_nothing[k] = -hidden.named[at].fit;
    }
  }
  const Eigen::MatrixXd moved = gain * off;
  std::vector<Eigen::Index> possible;
  for (Eigen::Index d = 0; d < moved.cols(); ++d) {
    if (allPositive(estimate.compliance + moved.col(d), estimate.identifiable)) possible.push_back(d);
  }
  constexpr Eigen::Index kOneOf = 20;  // draws: with fewer the data refuse the effects rather than their sizes
  if (kOneOf * static_cast<Eigen::Index>(possible.size()) < moved.cols()) return to_nothing;
  return off(Eigen::all, possible).rowwise().mean();
}

JointVector meanSquare(const Eigen::MatrixXd& rows) {
  if (rows.cols() == 0) return JointVector::Zero(rows.rows());
  return rows.rowwise().squaredNorm() / static_cast<double>(rows.cols());
}

class MethodWeigher {
 public:
  MethodWeigher(const HiddenDraws& hidden, const Declared& declared, bool unexplained)
      : hidden_(hidden), declared_(declared), unexplained_(unexplained) {}

  std::vector<BudgetLine> weigh(Method which, const JointsByColumn& gain, const StiffnessEstimate& alone,
                                const std::vector<effects::Effect>& in_model, StiffnessEstimate& estimate,
                                HiddenDraws::OfMethod& draws) const {
    const Eigen::MatrixXd moved_by_all = gain * hidden_.off;
    const std::vector<Eigen::Index> kept = possibleDraws(estimate, moved_by_all);
    const Eigen::MatrixXd moved = moved_by_all(Eigen::all, kept), off = hidden_.off(Eigen::all, kept);
    StiffnessEstimate own = estimate;  // without the effects, whose part the draws are
    own.parts.effects.setZero();
    own.covariance = own.parts.total();
    std::vector<BudgetLine> budget = sharedLines(own);
    addEffectLines(gain, off, moved, in_model, budget);
    estimate.parts.effects = moved * moved.transpose() / static_cast<double>(moved.cols());
    // Each is one number of which all joints have their share: a scale or a mass moves them together.
    JointMatrix by_columns = JointMatrix::Zero(estimate.joints(), estimate.joints());
    const auto addTogether = [&](BudgetSource source, const JointVector& by_one_sd) {
      budget.emplace_back(source, by_one_sd.cwiseAbs2());
      estimate.parts.effects += by_one_sd * by_one_sd.transpose();
    };
    if (declared_.gain_sd > 0.0) addTogether(BudgetSource::load_cell_gain, declared_.gain_sd * estimate.compliance);
    for (const Declared::Column& column : declared_.columns) {
      const JointVector& by_one_sd = column.compliance[static_cast<std::size_t>(which)];
      addTogether(column.source, by_one_sd);
      by_columns += by_one_sd * by_one_sd.transpose();
    }
    // About the stated value: half of what may be true is as far from it as this.
    if (unexplained_) addTogether(BudgetSource::apparent, std::sqrt(0.5) * (alone.compliance - estimate.compliance));
    estimate.covariance = estimate.parts.total();
    state(moved, own, alone, by_columns.diagonal(), estimate);
    draws.possible = kept;
    draws.compliance = moved.colwise() + (own.compliance - estimate.compliance);
    draws.others = identification::coveringCovariance(own) + by_columns;
    return budget;
  }

 private:
  static std::vector<BudgetLine> sharedLines(const StiffnessEstimate& own) {
    std::vector<BudgetLine> lines;
    const auto add = [&](BudgetSource source, const JointMatrix& part, const JointVector& dof) {
      if (part.diagonal().cwiseAbs().maxCoeff() > 0.0) lines.emplace_back(source, part.diagonal(), dof);
    };
    const JointVector exactly = JointVector::Zero(own.joints());
    add(BudgetSource::scatter, own.parts.scatter, own.scatter_dof);
    add(BudgetSource::frames, own.parts.frames, exactly);
    add(BudgetSource::wrist, own.parts.wrist, exactly);
    add(BudgetSource::geometry, own.parts.geometry, exactly);
    return lines;
  }

  void addEffectLines(const JointsByColumn& gain, const Eigen::MatrixXd& off, const Eigen::MatrixXd& moved,
                      const std::vector<effects::Effect>& in_model, std::vector<BudgetLine>& budget) const {
    JointVector common = meanSquare(moved);
    for (std::size_t first = 0; first < hidden_.effect.size();) {
      std::size_t end = first;
      while (end < hidden_.effect.size() && hidden_.effect[end] == hidden_.effect[first]) ++end;
      const auto from = static_cast<Eigen::Index>(first), count = static_cast<Eigen::Index>(end - first);
      const effects::Effect effect = hidden_.effect[first];
      BudgetLine line(BudgetSource::effect, meanSquare(gain.middleCols(from, count) * off.middleRows(from, count)));
      line.effect = effect;
      line.declared = hidden_.declared[first];
      line.in_model = std::find(in_model.begin(), in_model.end(), effect) != in_model.end();
      common -= line.variance;
      budget.push_back(line);
      first = end;
    }
    budget.emplace_back(BudgetSource::correlation, common);
  }

  /// Of an estimate, without what could hide: 1.96 times it is its interval.
  static double fitSd(const StiffnessEstimate& one, const JointVector& by_columns, int j) {
    return std::hypot(identification::coveringSd(one, j), std::sqrt(by_columns[j]));
  }

  /// A draw of the effects each, with some of everything else. `own`: uncertainty without effects; `by_columns`:
  /// variance by what is declared.
  std::vector<double> draws(const Eigen::MatrixXd& moved, const StiffnessEstimate& own, const StiffnessEstimate& alone,
                            const JointVector& by_columns, int j, numerics::RandomStream& random) const {
    const double sd = fitSd(own, by_columns, j), alone_sd = unexplained_ ? fitSd(alone, by_columns, j) : 0.0;
    std::vector<double> values;
    if (!std::isfinite(sd + alone_sd)) return values;
    constexpr int kEach = 2;
    for (Eigen::Index d = 0; d < moved.cols(); ++d) {
      for (int k = 0; k < kEach; ++k) {
        const double factor = 1.0 + declared_.gain_sd * random.normal();
        values.push_back(factor * (own.compliance[j] + moved(j, d) + sd * random.normal()));
        if (unexplained_) values.push_back(factor * (alone.compliance[j] + alone_sd * random.normal()));
      }
    }
    return values;
  }

  void state(const Eigen::MatrixXd& moved, const StiffnessEstimate& own, const StiffnessEstimate& alone,
             const JointVector& by_columns, StiffnessEstimate& estimate) const {
    // A fit with a negative stiffness is none: what the possible draws have in their middle stands for it.
    const bool possible = allPositive(own.compliance, own.identifiable);
    numerics::RandomStream random(1, "intervals");
    estimate.stated.assign(static_cast<std::size_t>(estimate.joints()), {});
    for (int j = 0; j < estimate.joints(); ++j) {
      if (!own.identifiable[static_cast<std::size_t>(j)]) continue;
      identification::CoverageInterval& interval = estimate.stated[static_cast<std::size_t>(j)];
      std::vector<double> values = draws(moved, own, alone, by_columns, j, random);
      if (values.empty()) {
        interval = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        continue;
      }
      std::sort(values.begin(), values.end());
      // An effect that only ever makes an arm softer lies on one side of the machine without it. Equal tails would
      // leave out just that machine.
      std::tie(interval.low, interval.high) = numerics::shortestInterval(values, identification::kStatedCoverage);
      if (!possible) estimate.compliance[j] = values[values.size() / 2];
      // The machine of the fit, with nothing more hidden in it, is known to its own uncertainty.
      const double by_gain = declared_.gain_sd * estimate.compliance[j];
      const double half = identification::kNormalFactor * std::hypot(fitSd(own, by_columns, j), by_gain);
      interval.low = std::min(interval.low, estimate.compliance[j] - half);
      interval.high = std::max(interval.high, estimate.compliance[j] + half);
    }
  }

  const HiddenDraws& hidden_;
  const Declared& declared_;
  bool unexplained_;
};

std::vector<SeenCombination> combinationsOf(const HiddenDraws& hidden, const JointsByColumn& gain,
                                            const StiffnessEstimate& estimate) {
  const Eigen::MatrixXd all = gain * hidden.off;
  const std::vector<Eigen::Index> kept = possibleDraws(estimate, all);
  const Eigen::MatrixXd moved = all(Eigen::all, kept);
  const JointMatrix by_others = estimate.parts.total() - moved * moved.transpose() / static_cast<double>(moved.cols());
  return seenCombinations(hidden.named, moved, hidden.off(Eigen::all, kept), by_others, estimate);
}

/// The radius of a reflector that took no part moves as that which moves most.
Eigen::MatrixXd ofAllReflectors(const Eigen::MatrixXd& moved, const frames::Frames& frames) {
  const frames::FramesLayout layout(frames.arm.arm.axes());
  const Eigen::Index seen = moved.rows(), all = layout.count(frames.targets_in_r0_at_zero.size());
  if (seen >= all || seen <= layout.radii) return moved;
  Eigen::Index most = 0;
  moved.bottomRows(seen - layout.radii).rowwise().squaredNorm().maxCoeff(&most);
  Eigen::MatrixXd extended(all, moved.cols());
  extended << moved, moved.row(layout.radii + most).replicate(all - seen, 1);
  return extended;
}

/// Puts what the draws do to the frames into their covariance. `alone`: of joint springs alone, where these are as
/// likely.
void weighFrames(const Eigen::MatrixXd& of_seen, const frames::Frames* alone, frames::Frames& frames) {
  if (of_seen.cols() == 0) return;
  const Eigen::MatrixXd moved = ofAllReflectors(of_seen, frames);
  frames.covariance.hidden = moved * moved.transpose() / static_cast<double>(moved.cols());
  if (alone != nullptr && alone->arm.points_placed) {
    const Eigen::VectorXd apart = frames::framesDifference(frames, *alone);
    frames.covariance.hidden += 0.5 * apart * apart.transpose();
  }
  frames::stateUncertainties(frames.covariance, frames.axes, frames.arm, frames.links, frames.wrist);
}

}  // namespace

HiddenEffects weighHiddenEffects(const diagnosis::GapStudy& study, const EffectFit& fitted,
                                 const campaign::Campaign& seen_campaign, const identification::Identification& seen,
                                 const identification::Identification& without, const frames::Frames& frames_without,
                                 const Declared& declared, identification::Identification& with) {
  HiddenEffects result;
  const diagnosis::GapFit& fit = study.fit;
  result.lack_of_fit = fit.left_before.perEquation();
  result.left_over = diagnosis::leftPerEquation(fit);
  result.left_limit = fit.left_limit;
  // A model without effects explains nothing. Not by chi2, in whose noise is what no effect explains.
  if (result.lack_of_fit > 1.0) result.unexplained_share = fitted.free.empty() ? 1.0 : fitted.gap.shareLeft();
  // A model that explains seven eighths of the gap is the better one wherever that was tried.
  constexpr double kShare = 0.15;
  result.unexplained = diagnosis::leavesUnexplained(fit) && result.unexplained_share > kShare;
  result.draws = hiddenDraws(study, fitted, declared);
  const HiddenDraws& hidden = result.draws;
  result.gain_sd = declared.gain_sd;
  const std::vector<CaseEffects> cases = caseEffects(study, hidden.columns, seen);
  std::vector<effects::Effect> in_model;
  for (const AddedEffect& one : fitted.added) in_model.push_back(one.effect);
  const MethodWeigher weigher(hidden, declared, result.unexplained);
  const Method of_sag =
      with.of(Method::decoupled_partial_pose).available ? Method::decoupled_partial_pose : Method::partial_pose;
  const Method shown = identification::bestMethod(with);
  for (const Method which : identification::kMethods) {
    const auto at = static_cast<std::size_t>(which);
    if (!with.of(which).available || !seen.of(which).available || !without.of(which).available) continue;
    const auto gain = gains(cases, seen, which, hidden.off.rows());
    if (gain.cols() == 0) continue;
    const StiffnessEstimate& fit_of_method = with.of(which).estimate;
    if (which == shown && !in_model.empty() && !allPositive(fit_of_method.compliance, fit_of_method.identifiable) &&
        allPositive(without.of(which).estimate.compliance, without.of(which).estimate.identifiable))
      result.to_possible = toPossible(hidden, gain, fit_of_method, in_model);
    if (which == of_sag) {
      const Eigen::MatrixXd moved = gain * hidden.off;
      const std::vector<Eigen::Index> kept = possibleDraws(seen.of(which).estimate, moved);
      weighFrames(framesByEffects(study, hidden.columns, hidden.off(Eigen::all, kept), moved(Eigen::all, kept),
                                  seen_campaign, seen.frames, seen.of(which).estimate.compliance.cwiseMax(0.0)),
                  result.unexplained ? &frames_without : nullptr, with.frames);
    }
    result.budget[at] = weigher.weigh(which, gain, without.of(which).estimate, in_model, with.methods[at].estimate,
                                      result.draws.methods[at]);
    if (!result.unexplained) result.combinations[at] = combinationsOf(hidden, gain, with.methods[at].estimate);
  }
  return result;
}

}  // namespace stiffscope::extended_model
