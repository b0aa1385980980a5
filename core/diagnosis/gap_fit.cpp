#include "core/diagnosis/gap_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/audit/nest_network.h"

namespace stiffscope {

namespace {

constexpr int kAlone = 2;  // rounds for the largest effect by itself

std::vector<double> ones(const GapData& data) { return std::vector<double>(data.postures.size(), 1.0); }

/// Parameters of one model in a vector of all effects' parameters.
Eigen::VectorXd ownOf(const GapInput& input, const GapLayout& layout, const Eigen::VectorXd& effects,
                      std::size_t m) {
  return effects.segment(layout.model_at[m] - layout.effects,
                         static_cast<Eigen::Index>(input.models[m].parameters()));
}

/// Effects that the equations contain once they are estimated: a corrected wrench, frame or unloaded place.
bool isCorrection(Effect effect) {
  return effect == Effect::load_point_error || effect == Effect::load_cell_misalignment ||
         effect == Effect::load_cell_bias || effect == Effect::frame_error ||
         effect == Effect::gravity_compensator;
}

/// Puts the estimates into what the next linearisation starts from; returns those that its equations then
/// contain.
ContainedEffects correct(const GapInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, GapState& state) {
  const Vector6d before = state.at.compliance;
  state.at.compliance = nuisances.head<6>().cwiseMax(0.0);
  state.geometry.compliance = state.geometry.weight.links_known ? state.at.compliance : Vector6d::Zero();
  const Eigen::VectorXd steps = nuisances.segment(layout.geometry, layout.weights - layout.geometry);
  if (input.absolute) {
    const LoadingGeometry there = moved(state.geometry, steps, state.at.epoch_centre);
    state.r0_from_sweeps =
        motionAbout(state.at.epoch_centre, steps.segment<6>(GeometrySteps::kAxes)) * state.r0_from_sweeps;
    state.geometry = there;
  }
  state.corrections = {};
  state.at.compensator.resize(0);
  ContainedEffects contained{Eigen::VectorXd::Zero(set.effects.size()),
                             Eigen::VectorXd::Zero(set.effects.size())};
  state.at.turns.clear();
  state.at.harder_by_square.setZero();
  state.at.harder_by_size.setZero();
  for (const ChosenModel& one : set.models) {
    const EffectModel& model = input.models[one.model];
    Eigen::VectorXd own = ownOf(input, layout, set.effects, one.model);
    const Eigen::Index at = layout.model_at[one.model] - layout.effects;
    switch (model.effect) {
      case Effect::load_point_error:
        state.corrections.load_point = own;
        break;
      case Effect::load_cell_misalignment:
        state.corrections.cell_turn = own;
        break;
      case Effect::load_cell_bias:
        if (own.size() == 3) state.corrections.cell_force = own;
        if (own.size() == 1) state.corrections.missing_weight = own[0];
        break;
      case Effect::frame_error:
        state.corrections.frame = own;
        break;
      case Effect::gravity_compensator:
        // The torque turns the joint by the compliance of the equations it was found in.
        if (before[1] <= 0.0 || state.at.compliance[1] <= 0.0) continue;
        own *= before[1] / state.at.compliance[1];
        state.at.compensator = own;
        break;
      case Effect::backlash:
        state.at.play = own.head<6>();
        state.at.passage = std::clamp(state.at.passage + own[6], 1.0, 1000.0);
        own[6] = 0.0;
        break;
      case Effect::joint_hardening:
        (model.parts.front().unit == "rad/Nm^3" ? state.at.harder_by_square : state.at.harder_by_size) =
            (state.at.compliance.array() > 0.0).select(own.array() / state.at.compliance.array(), 0.0);
        break;
      case Effect::hysteresis:
        for (Eigen::Index j = 0; j < 6; ++j) {
          state.at.friction[j] = state.at.compliance[j] > 0.0 ? own[j] / state.at.compliance[j] : 0.0;
        }
        continue;
      default:
        break;
    }
    if (model.angles) state.at.turns.push_back({model.angles, own});
    const bool in_deflections = model.effect == Effect::gravity_compensator || !model.angles;
    if (model.angles || isCorrection(model.effect)) contained.in_positions.segment(at, own.size()) = own;
    if (in_deflections && isCorrection(model.effect)) contained.in_deflections.segment(at, own.size()) = own;
  }
  return contained;
}

/// Variance factors of the absolute positions, from what the largest model (all effects at once) leaves.
void findSlack(const GapInput& input, const GapData& data, GapState& state) {
  if (!input.absolute) return;
  const Eigen::Index end = data.layout.end;
  Eigen::MatrixXd normal = sumOf(data, ones(data));
  std::size_t m = 0;
  for (const EffectModel& model : input.models) {
    Eigen::Index at = data.layout.model_at[m++];
    for (const EffectPart& part : model.parts) {
      for (const double most : part.most) normal(at, at) += 1.0 / (most * most), ++at;
    }
  }
  Eigen::VectorXd scale =
      normal.diagonal().head(end).unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  Eigen::MatrixXd even = scale.asDiagonal() * normal.topLeftCorner(end, end) * scale.asDiagonal();
  even.diagonal().setConstant(1.0 + 1e-10);
  const Eigen::VectorXd all =
      scale.asDiagonal() * even.ldlt().solve(Eigen::VectorXd(scale.asDiagonal() * normal.col(end).head(end)));
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : data.postures) {
    const Eigen::Index rows = posture.position_rows;
    if (rows == 0) continue;
    Eigen::VectorXd left = posture.right.head(rows) - posture.columns.topRows(rows) * all;
    posture.lower.topLeftCorner(rows, rows).triangularView<Eigen::Lower>().solveInPlace(left);
    squares += left.squaredNorm();
    count += static_cast<double>(rows);
  }
  if (count > 0.0) state.position_slack = std::max(1.0, state.position_slack * squares / count);
  if (data.sweep_rows > 0) {
    Eigen::VectorXd both(end + 1);
    both << all, -1.0;
    const double left = both.dot(data.sweeps * both);
    state.sweep_slack = std::max(1.0, state.sweep_slack * left / static_cast<double>(data.sweep_rows));
  }
}

SelectionRules rulesFor(const GapData& data, const FitRules& rules) {
  SelectionRules out;
  out.loading_rows = static_cast<double>(data.loading_rows);
  out.other_rows = static_cast<double>(data.sweep_rows);
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : data.postures) {
    const Eigen::Index rows = posture.right.size() - posture.position_rows;
    squares += posture.right.tail(rows).squaredNorm();
    count += static_cast<double>(rows);
  }
  const double deflection = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  const double limit =
      std::max(rules.noise_share,
               data.state_noise > 0.0 ? rules.deflection_share * deflection / data.state_noise : 0.0);
  out.least_drop = limit * limit * out.loading_rows;
  return out;
}

}  // namespace

GapState startState(const Evidence& evidence, const LoadingGeometry& geometry) {
  GapState state;
  state.geometry = geometry;
  state.at.compliance = geometry.compliance.cwiseMax(0.0);
  state.at.targets = static_cast<int>(evidence.campaign.targets.size());
  state.at.r0_from_base_link = geometry.r0_from_base_link;
  if (geometry.r0_from_loading) state.r0_from_sweeps = *geometry.r0_from_loading;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const State& row : evidence.campaign.states->rows) {
    state.at.largest_force = std::max(state.at.largest_force, row.wrench_in_cell.head<3>().norm());
    if (std::isfinite(row.time_s)) first = std::min(first, row.time_s), last = std::max(last, row.time_s);
  }
  if (last > first) state.at.first_time = first, state.at.time_span = last - first;
  state.at.sweep_time = std::isfinite(first) ? first : 0.0;
  if (geometry.r0_from_loading && evidence.campaign.loading && !evidence.campaign.loading->rows.empty()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const LoadingReading& row : evidence.campaign.loading->rows) sum += row.point;
    state.at.epoch_centre =
        *geometry.r0_from_loading * (sum / static_cast<double>(evidence.campaign.loading->rows.size()));
  }
  return state;
}

Vector6d complianceVariance(const GapFit& fit, const GapInput& input) {
  const GapLayout& layout = fit.data.layout;
  const Eigen::MatrixXd normal = sumOf(fit.data, ones(fit.data));
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < layout.effects; ++i) kept.push_back(i);
  for (const ChosenModel& one : fit.set.models) {
    const auto count = static_cast<Eigen::Index>(input.models[one.model].parameters());
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index i = layout.model_at[one.model] + k;
      if (fit.set.effects[i - layout.effects] != 0.0) kept.push_back(i);
    }
  }
  Eigen::MatrixXd matrix = normal(kept, kept);
  const Eigen::VectorXd scale =
      matrix.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
  matrix.diagonal().setConstant(1.0 + 1e-10);
  const Eigen::MatrixXd inverse = matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), 6));
  Vector6d variance;
  for (Eigen::Index j = 0; j < 6; ++j) variance[j] = scale[j] * scale[j] * inverse(j, j);
  return variance;
}

Selector selectorOf(const GapInput& input, const GapFit& fit, const Projection& projection, double postures,
                    const std::vector<bool>& allowed) {
  return Selector(input.models, fit.data.layout, projection, postures, fit.rules, allowed);
}

double leftPerEquation(const GapFit& fit) {
  return (fit.set.chi2 - fit.rules.other_rows) / fit.rules.loading_rows;
}

namespace {

using ModelsAndParts = std::vector<std::pair<std::size_t, std::vector<std::size_t>>>;

ModelsAndParts namesOf(const FittedSet& set) {
  ModelsAndParts names;
  for (const ChosenModel& one : set.models) names.emplace_back(one.model, one.parts);
  return names;
}

/// One linearisation where `fit.state` stands, and the selection on it.
void fitOnce(const GapInput& input, const std::vector<bool>& allowed, const FitRules& rules, GapFit& fit) {
  fit.rules = rulesFor(fit.data, rules);
  fit.rules.given = rules.given;
  // A large effect bends what the others are judged by: it is settled before a second one is looked for.
  if (fit.rounds <= kAlone) fit.rules.most_effects = 1;
  fit.projection = project(sumOf(fit.data, ones(fit.data)), fit.data.layout.effects);
  const double postures = static_cast<double>(fit.data.postures.size());
  const Selector selector = selectorOf(input, fit, fit.projection, postures, allowed);
  fit.set = rules.fixed ? selector.fit(*rules.fixed) : selector.select();
  fit.nuisances_before = fit.projection.by_nothing;
  fit.nuisances = fit.projection.by_nothing - fit.projection.by_effects * fit.set.effects;
}

GapFit settle(const GapInput& input, const GapState& start, const std::vector<bool>& allowed,
              const FitRules& rules) {
  GapFit fit;
  fit.state = start;
  ContainedEffects contained;
  ModelsAndParts last;
  double last_chi2 = 0.0;
  constexpr int kMostRounds = 9;
  for (fit.rounds = 1; fit.rounds <= kMostRounds; ++fit.rounds) {
    fit.data = gapData(input, fit.state, contained);
    if (fit.rounds > kAlone) {
      const GapState before = fit.state;
      findSlack(input, fit.data, fit.state);
      if (fit.state.position_slack != before.position_slack || fit.state.sweep_slack != before.sweep_slack)
        fit.data = gapData(input, fit.state, contained);
    }
    fitOnce(input, allowed, rules, fit);
    const ModelsAndParts now = namesOf(fit.set);
    constexpr double kSettled = 0.003;  // of chi2: far below what a verdict turns on
    const bool settled = now == last && std::abs(fit.set.chi2 - last_chi2) < kSettled * fit.set.chi2;
    if (fit.rounds >= kAlone + 2 && settled) break;
    last = now;
    last_chi2 = fit.set.chi2;
    if (fit.rounds < kMostRounds)
      contained = correct(input, fit.data.layout, fit.set, fit.nuisances, fit.state);
  }
  return fit;
}

/// rms per coordinate of what the fit leaves at the largest load of each posture, less the noise.
double leftAtLargestLoad(const GapFit& fit) {
  Eigen::VectorXd all(fit.nuisances.size() + fit.set.effects.size());
  all << fit.nuisances, fit.set.effects;
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : fit.data.postures) {
    const Eigen::VectorXd left = posture.right - posture.columns * all;
    const std::size_t s = heaviestState(posture.states);
    if (s == 0) continue;
    const Eigen::Index per_state = posture.states.front().rows();
    const Eigen::Index at = posture.position_rows + static_cast<Eigen::Index>(s - 1) * per_state;
    squares +=
        left.segment(at, per_state).squaredNorm() - posture.noise.diagonal().segment(at, per_state).sum();
    count += static_cast<double>(per_state);
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count)) : 0.0;
}

/// What is left beyond noise where that is significant and matters, else 0.
double modelError(const GapFit& fit, const FitRules& rules) {
  const double rows = fit.rules.loading_rows, left = leftPerEquation(fit);
  constexpr double kSigmas = 4.0;
  const double doubt = std::sqrt(2.0 / rows + (rules.noise_degrees > 0.0 ? 2.0 / rules.noise_degrees : 0.0));
  if (fit.state.model_error == 0.0 && left - 1.0 < kSigmas * doubt) return 0.0;
  double before = 0.0, after = 0.0, count = 0.0;
  Eigen::VectorXd old = Eigen::VectorXd::Zero(fit.data.layout.end), now = old;
  old.head(fit.nuisances_before.size()) = fit.nuisances_before;
  now << fit.nuisances, fit.set.effects;
  for (const GapPosture& posture : fit.data.postures) {
    const Eigen::Index loads = posture.right.size() - posture.position_rows;
    before += (posture.right - posture.columns * old).tail(loads).squaredNorm();
    after += (posture.right - posture.columns * now).tail(loads).squaredNorm();
    count += static_cast<double>(loads);
  }
  const double removed = std::sqrt(std::max(0.0, before - after) / count);
  constexpr double kShareOfRemoved = 0.1;  // linear models of large effects are not exact to more
  const double limit =
      std::max(std::sqrt(fit.rules.least_drop / rows) * fit.data.state_noise, kShareOfRemoved * removed);
  const double error =
      fit.state.model_error == 0.0
          ? std::max(leftAtLargestLoad(fit), std::sqrt(std::max(0.0, left - 1.0)) * fit.data.state_noise)
          : leftAtLargestLoad(fit);
  return error > limit ? error : 0.0;
}

}  // namespace

GapFit fitGap(const GapInput& input, const GapState& start, const std::vector<bool>& allowed,
              const FitRules& rules) {
  GapFit fit = settle(input, start, allowed, rules);
  GapState with_error = start;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    fit.model_error = modelError(fit, rules);
    // What no effect explains is noise to every effect from here on, and stays the same however often it is
    // measured.
    if (std::abs(fit.model_error - with_error.model_error) < 0.02 * fit.model_error || fit.model_error == 0.0)
      break;
    with_error.model_error = fit.model_error;
    fit = settle(input, with_error, allowed, rules);
  }
  fit.model_error = modelError(fit, rules);
  return fit;
}

}  // namespace stiffscope
