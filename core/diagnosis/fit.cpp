#include "core/diagnosis/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/diagnosis/geometry_columns.h"
#include "core/diagnosis/projection.h"
#include "core/diagnosis/selection.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

/// What the set leaves of the deflection at the largest load beyond noise, rms per coordinate, m, where that
/// is significant (four standard deviations of chi2, the noise's own doubt in it) and matters: more than the
/// smallest effect looked for, and more than a tenth of what the set removed, because models of large effects
/// are not exact to more. Else 0.
double modelError(const GapFit& fit, const FitRules& rules);

namespace {

constexpr int kAlone = 2;  // rounds for the largest effect by itself

std::vector<double> ones(const LinearSystem& data) { return std::vector<double>(data.postures.size(), 1.0); }

SelectionRules rulesFor(const LinearSystem& data, const FitRules& rules) {
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
  const double limit = std::max(rules.noise_share,
                                data.state_noise > 0.0 ? rules.deflection_share * deflection / data.state_noise : 0.0);
  out.least_drop = limit * limit * out.loading_rows;
  return out;
}

}  // namespace

JointVector complianceVariance(const GapFit& fit, const SystemInput& input) {
  const GapLayout& layout = fit.data->layout;
  const Eigen::MatrixXd normal = sumOf(*fit.data, ones(*fit.data));
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
  const Eigen::MatrixXd inverse = solveSymmetric(matrix, Eigen::MatrixXd::Identity(matrix.rows(), layout.joints()));
  JointVector variance(layout.joints());
  for (Eigen::Index j = 0; j < layout.joints(); ++j) variance[j] = scale[j] * scale[j] * inverse(j, j);
  return variance;
}

double varianceFactor(const GapFit& fit) {
  return std::max(1.0, (fit.set.chi2 - fit.rules.other_rows) / fit.rules.loading_rows);
}

Selector selectorOf(const SystemInput& input, const GapFit& fit, const Projection& projection, double postures,
                    const std::vector<bool>& allowed) {
  return Selector(input.models, fit.data->layout, projection, postures, fit.rules, allowed);
}

namespace {

/// `normal`: all normal equations; effects that are zero take no degree of freedom.
LoadingResidual residualOfLoading(const SystemInput& input, const LinearSystem& data, const Eigen::MatrixXd& normal,
                                  const Eigen::VectorXd& nuisances, const Eigen::VectorXd& effects) {
  const GapLayout& layout = data.layout;
  const Eigen::MatrixXd loading = normal - data.sweeps;
  Eigen::VectorXd both(layout.end + 1);
  both << nuisances, effects, -1.0;
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(layout.end);
  prior.tail(layout.end - layout.effects) = priorsOf(input.models);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < layout.end; ++i) {
    if (normal(i, i) > 0.0 && (i < layout.effects || effects[i - layout.effects] != 0.0)) free.push_back(i);
  }
  Eigen::MatrixXd matrix = normal(free, free);
  matrix.diagonal() += prior(free);
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
  matrix.diagonal().setConstant(1.0 + 1e-12);
  const Eigen::MatrixXd taken = solveSymmetric(matrix, scale.asDiagonal() * loading(free, free) * scale.asDiagonal());
  return {both.dot(loading * both), std::max(1.0, static_cast<double>(data.loading_rows) - taken.trace())};
}

using ModelsAndParts = std::vector<std::pair<std::size_t, std::vector<std::size_t>>>;

ModelsAndParts namesOf(const FittedSet& set) {
  ModelsAndParts names;
  for (const ChosenModel& one : set.models) names.emplace_back(one.model, one.parts);
  return names;
}

/// One linearisation where `fit.state` stands, and the selection on it.
void fitOnce(const SystemInput& input, const std::vector<bool>& allowed, const FitRules& rules, GapFit& fit) {
  fit.rules = rulesFor(*fit.data, rules);
  fit.rules.given = rules.given;
  fit.rules.loaded = input.expected.known;
  // A large effect bends what the others are judged by: it is settled before a second one is looked for.
  if (fit.rounds <= kAlone) fit.rules.most_effects = 1;
  const Eigen::MatrixXd normal = sumOf(*fit.data, ones(*fit.data));
  fit.projection = project(normal, fit.data->layout);
  const double postures = static_cast<double>(fit.data->postures.size());
  const Selector selector = selectorOf(input, fit, fit.projection, postures, allowed);
  fit.set = rules.fixed ? selector.fit(*rules.fixed) : selector.select();
  fit.nuisances_before = fit.projection.by_nothing;
  fit.nuisances = fit.projection.by_nothing - fit.projection.by_effects * fit.set.effects;
  fit.left = residualOfLoading(input, *fit.data, normal, fit.nuisances, fit.set.effects);
  fit.left_before =
      residualOfLoading(input, *fit.data, normal, fit.nuisances_before, Eigen::VectorXd::Zero(fit.set.effects.size()));
}

/// How far the shapes in the set are from where its equations were made, and where that is: logarithms.
struct Shapes {
  double farthest = 0.0, at = 0.0;

  /// chi2 says late that they stand: a long step fits the readings as well, and no other load. One that is held at its
  /// bound stands, too.
  bool stand(const Shapes& before) const {
    constexpr double kShort = 0.05;
    return farthest < kShort || std::abs(at - before.at) < kShort;
  }
};

Shapes shapesOf(const SystemInput& input, const GapFit& fit) {
  Shapes shapes;
  for (const ChosenModel& one : fit.set.models) {
    const effects::EffectModel& model = input.models[one.model];
    Eigen::Index at = fit.data->layout.model_at[one.model] - fit.data->layout.effects;
    for (const effects::EffectPart& part : model.parts) {
      if (part.is_shape) {
        shapes.farthest = std::max(shapes.farthest, std::abs(fit.set.effects[at]));
        shapes.at += std::log(model.shapeAt(fit.state.at));
      }
      at += static_cast<Eigen::Index>(part.most.size());
    }
  }
  return shapes;
}

/// The equations where the fit stands, the ones it had let go first.
std::shared_ptr<LinearSystem> remade(const SystemInput& input, const ContainedEffects& contained,
                                     GeometryColumns& by_geometry, GapFit& fit, Weighed weighed = Weighed::once) {
  fit.data = std::make_shared<const LinearSystem>();
  return std::make_shared<LinearSystem>(linearSystem(input, fit.state, contained, by_geometry, weighed));
}

GapFit settle(const SystemInput& input, const SystemState& start, const std::vector<bool>& allowed,
              const FitRules& rules, GeometryColumns& by_geometry) {
  GapFit fit, best;  // the best without its equations, of which a long day has many: they can be made again
  fit.state = start;
  ContainedEffects contained, best_contained;
  ModelsAndParts last;
  double last_chi2 = 0.0;
  Shapes last_shapes;
  constexpr int kMostRounds = 9;
  for (fit.rounds = 1; fit.rounds <= kMostRounds; ++fit.rounds) {
    const bool inflates = input.absolute && fit.rounds > kAlone;
    const auto data = remade(input, contained, by_geometry, fit, inflates ? Weighed::again : Weighed::once);
    if (inflates) {
      const SystemState before = fit.state;
      estimateInflation(input, *data, fit.state);
      if (fit.state.position_inflation != before.position_inflation ||
          fit.state.sweep_inflation != before.sweep_inflation)
        weighAgain(input, fit.state, *data);
      data->as_read = {};
    }
    fit.data = data;
    fitOnce(input, allowed, rules, fit);
    const ModelsAndParts now = namesOf(fit.set);
    constexpr double kSettled = 0.003;  // of chi2: far below what a verdict turns on
    const Shapes shapes = shapesOf(input, fit);
    const bool stand = !rules.fixed || (fit.rounds > kAlone && shapes.stand(last_shapes));
    const bool settled = now == last && std::abs(fit.set.chi2 - last_chi2) < kSettled * fit.set.chi2 && stand;
    last = now;
    last_chi2 = fit.set.chi2;
    last_shapes = shapes;
    // Where sets are chosen, rounds may settle at one where a round before had seen more.
    const bool as_good = rules.fixed || best.rounds == 0 || fit.set.score() < (1.0 + kSettled) * best.set.score();
    if (fit.rounds >= kAlone + 2 && settled && as_good) return fit;
    // Of the first ones the equations do not yet contain what they find.
    if (fit.rounds > kAlone && (best.rounds == 0 || !stand || fit.set.score() < best.set.score())) {
      best = fit;
      best.data = std::make_shared<const LinearSystem>();
      best_contained = contained;
    }
    if (fit.rounds == kMostRounds) break;
    contained = correct(input, fit.data->layout, fit.set, fit.nuisances, fit.state);
    if (!rules.fixed) {
      const double postures = static_cast<double>(fit.data->postures.size());
      settleRivals(input, fit, selectorOf(input, fit, fit.projection, postures, allowed), allowed, fit.state.at);
    }
  }
  fit.data = std::make_shared<const LinearSystem>();
  best.data = remade(input, best_contained, by_geometry, best);
  return best;
}

/// The chosen set at the minimum of the nonlinear problem, where that is lower than what relinearising came
/// to.
void polish(const SystemInput& input, const std::vector<bool>& allowed, const FitRules& rules,
            GeometryColumns& by_geometry, GapFit& fit) {
  const auto fitted = fitJointly(input, fit.state, fit.data->layout, fit.set, fit.nuisances, by_geometry);
  if (!fitted) return;
  FitRules same = rules;
  same.fixed = fit.set.models;
  GapFit finer;
  finer.state = fitted->state;
  finer.rounds = fit.rounds + 1;
  finer.data = remade(input, fitted->contained, by_geometry, finer);
  fitOnce(input, allowed, same, finer);
  if (finer.set.chi2 >= fit.set.chi2 || !finer.set.plausible) return;
  finer.model_error = fit.model_error;
  fit = std::move(finer);
}

}  // namespace

GapFit withoutEffects(const SystemInput& input, const SystemState& start, const GapFit& fit) {
  SystemInput bare = input;
  bare.models.clear();
  GapFit alone;
  alone.rules = fit.rules;
  alone.state = start;
  alone.state.position_inflation = fit.state.position_inflation;
  alone.state.sweep_inflation = fit.state.sweep_inflation;
  alone.state.model_error = fit.state.model_error;
  GeometryColumns own;
  alone.data = std::make_shared<const LinearSystem>(
      linearSystem(bare, alone.state, {}, fit.by_geometry ? *fit.by_geometry : own));
  const Eigen::MatrixXd normal = sumOf(*alone.data, ones(*alone.data));
  alone.projection = project(normal, alone.data->layout);
  alone.nuisances = alone.nuisances_before = alone.projection.by_nothing;
  alone.left = alone.left_before = residualOfLoading(bare, *alone.data, normal, alone.nuisances, Eigen::VectorXd());
  return alone;
}

GapFit fitGap(const SystemInput& input, const SystemState& start, const std::vector<bool>& allowed,
              const FitRules& rules) {
  const auto by_geometry = std::make_shared<GeometryColumns>();
  GapFit fit = settle(input, start, allowed, rules, *by_geometry);
  SystemState with_error = start;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds && rules.error_of_model; ++round) {
    fit.model_error = modelError(fit, rules);
    // What no effect explains is noise to every effect from here on, and stays the same however often it is
    // measured.
    if (std::abs(fit.model_error - with_error.model_error) < 0.02 * fit.model_error || fit.model_error == 0.0) break;
    with_error.model_error = fit.model_error;
    fit = {};
    fit = settle(input, with_error, allowed, rules, *by_geometry);
  }
  polish(input, allowed, rules, *by_geometry, fit);
  if (rules.error_of_model) fit.model_error = modelError(fit, rules);
  fit.by_geometry = by_geometry;
  fit.left_limit = limitOfChiSquare(fit.left.freedom, rules.noise_degrees);
  return fit;
}

namespace {

/// rms per coordinate of what the fit leaves at the largest load of each posture, less the noise.
double leftAtLargestLoad(const GapFit& fit) {
  Eigen::VectorXd all(fit.nuisances.size() + fit.set.effects.size());
  all << fit.nuisances, fit.set.effects;
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : fit.data->postures) {
    const Eigen::VectorXd left = posture.right - posture.columns * all;
    const std::size_t s = effects::heaviestState(posture.states);
    if (s == 0) continue;
    const Eigen::Index per_state = posture.states.front().rows();
    const Eigen::Index at = posture.position_rows + static_cast<Eigen::Index>(s - 1) * per_state;
    squares += left.segment(at, per_state).squaredNorm() - posture.noiseSquares(at, per_state);
    count += static_cast<double>(per_state);
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count)) : 0.0;
}

}  // namespace

double limitOfChiSquare(double freedom, double noise_degrees) {
  constexpr double kSigmas = 4.0, kAsDeclared = 1.6;  // declared noise is right to a quarter
  if (noise_degrees > 0.0) return 1.0 + kSigmas * std::sqrt(2.0 / freedom + 2.0 / noise_degrees);
  return kAsDeclared + kSigmas * std::sqrt(2.0 / freedom);
}

double modelError(const GapFit& fit, const FitRules& rules) {
  const double rows = fit.rules.loading_rows, left = leftPerEquation(fit);
  if (fit.state.model_error == 0.0 && left < limitOfChiSquare(fit.left.freedom, rules.noise_degrees)) return 0.0;
  double before = 0.0, after = 0.0, count = 0.0;
  Eigen::VectorXd old = Eigen::VectorXd::Zero(fit.data->layout.end), now = old;
  old.head(fit.nuisances_before.size()) = fit.nuisances_before;
  now << fit.nuisances, fit.set.effects;
  for (const GapPosture& posture : fit.data->postures) {
    const Eigen::Index loads = posture.right.size() - posture.position_rows;
    before += (posture.right - posture.columns * old).tail(loads).squaredNorm();
    after += (posture.right - posture.columns * now).tail(loads).squaredNorm();
    count += static_cast<double>(loads);
  }
  const double removed = std::sqrt(std::max(0.0, before - after) / count);
  constexpr double kShareOfRemoved = 0.1;
  const double limit =
      std::max(std::sqrt(fit.rules.least_drop / rows) * fit.data->state_noise, kShareOfRemoved * removed);
  const double error =
      fit.state.model_error == 0.0
          ? std::max(leftAtLargestLoad(fit), std::sqrt(std::max(0.0, left - 1.0)) * fit.data->state_noise)
          : leftAtLargestLoad(fit);
  return error > limit ? error : 0.0;
}

}  // namespace stiffscope::diagnosis
