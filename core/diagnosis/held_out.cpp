#include "core/diagnosis/held_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>

#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"

namespace stiffscope::diagnosis {

namespace {

struct Trained {
  StiffnessesAlone before;
  Eigen::VectorXd after;
};

/// One training sample (weights of the postures): every recipe fitted. `sum`, `sum_alone`: of its equations, with
/// effects and without.
std::vector<Trained> train(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                           const std::vector<bool>& allowed, const std::vector<FitRecipe>& recipes,
                           const std::vector<double>& weights, const Eigen::MatrixXd& sum,
                           const Eigen::MatrixXd& sum_alone) {
  double postures = 0.0;
  for (const double weight : weights) postures += weight;
  const Projection projection = project(sum, fit.data->layout);
  SelectionRules rules = fit.rules;
  const double share = postures / static_cast<double>(fit.data->postures.size());
  rules.loading_rows *= share;
  rules.least_drop *= share;
  const Selector selector(input.models, fit.data->layout, projection, std::max(2.0, postures), rules, allowed);
  const StiffnessesAlone before = stiffnessesAlone(*alone.data, weights, project(sum_alone, alone.data->layout));
  std::vector<Trained> trained;
  for (const FitRecipe& recipe : recipes) {
    const FittedSet set = recipe.choose ? selector.select() : selector.fit(recipe.models);
    trained.push_back(
        {before, allParameters(projection.by_nothing - projection.by_effects * set.effects, set.effects)});
  }
  return trained;
}

/// Trains on each sample and hands it to take(sample, trained). Each thread takes a few samples at a time, whose
/// equations are summed together.
template <class Take>
void trainOnEach(const SystemInput& input, const GapFit& alone, const GapFit& fit, const std::vector<bool>& allowed,
                 const std::vector<FitRecipe>& recipes, const std::vector<numerics::Weights>& samples,
                 const Take& take) {
  constexpr std::size_t kTogether = 5;  // half a megabyte each; the more, the less evenly are threads loaded
  numerics::onAllCores((samples.size() + kTogether - 1) / kTogether, [&](std::size_t block) {
    const std::size_t first = block * kTogether;
    const std::span some = std::span(samples).subspan(first, std::min(kTogether, samples.size() - first));
    const std::vector<Eigen::MatrixXd> sums = sumsOf(*fit.data, some), sums_alone = sumsOf(*alone.data, some);
    for (std::size_t k = 0; k < some.size(); ++k)
      take(first + k, train(input, alone, fit, allowed, recipes, some[k], sums[k], sums_alone[k]));
  });
}

/// All postures but one, for each.
std::vector<numerics::Weights> othersOfEach(std::size_t postures) {
  std::vector<numerics::Weights> others;
  for (std::size_t p = 0; p < postures; ++p) others.push_back(numerics::leaveOneOut(postures, p));
  return others;
}

constexpr std::size_t kFewestHeldOut = 4;  // postures

HeldOutShrink notJudged() {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const Shrink none{kUnknown, kUnknown, kUnknown};
  return {none, none, kUnknown};
}

double shrinkOf(double before, double after) { return before > 0.0 ? 1.0 - std::sqrt(after / before) : 0.0; }

/// Spread of the bootstrap about its median, narrowed by the root of judged over all postures, put on the value.
Shrink withInterval(double value, std::vector<double> drawn, double judged_share, std::size_t postures) {
  const numerics::BootstrapSpread spread = numerics::bootstrapSpread(std::move(drawn), static_cast<double>(postures));
  const double scale = std::sqrt(judged_share);
  return {value, value - scale * spread.below, value + scale * spread.above};
}

void add(HeldOut& sum, const HeldOut& one) {
  sum.deflection_before += one.deflection_before;
  sum.deflection_after += one.deflection_after;
  sum.position_before += one.position_before;
  sum.position_after += one.position_after;
}

}  // namespace

HeldOut leftIn(const GapPosture& alone, const StiffnessesAlone& before, const GapPosture& posture,
               const Eigen::VectorXd& after) {
  const Eigen::VectorXd now = posture.right - posture.columns * after;
  const Eigen::Index rest = posture.position_rows, rows = posture.right.size() - rest;
  const auto left = [&](const Eigen::VectorXd& old) { return alone.right - alone.columns * old; };
  return {left(before.for_deflection).tail(rows).squaredNorm(), now.tail(rows).squaredNorm(),
          left(before.for_position).head(rest).squaredNorm(), now.head(rest).squaredNorm()};
}

HeldOutShrink shrinkOver(const std::vector<HeldOut>& postures, int resamples, std::uint64_t seed) {
  if (postures.size() < kFewestHeldOut) return notJudged();
  HeldOut sum;
  for (const HeldOut& one : postures) add(sum, one);
  std::mt19937_64 random(seed);
  std::vector<double> deflections, positions;
  for (int b = 0; b < resamples; ++b) {
    HeldOut drawn;
    numerics::drawWithReplacement(random, postures.size(), [&](std::size_t posture) { add(drawn, postures[posture]); });
    deflections.push_back(shrinkOf(drawn.deflection_before, drawn.deflection_after));
    positions.push_back(shrinkOf(drawn.position_before, drawn.position_after));
  }
  HeldOutShrink result;
  result.deflection =
      withInterval(shrinkOf(sum.deflection_before, sum.deflection_after), deflections, 1.0, postures.size());
  result.position = withInterval(shrinkOf(sum.position_before, sum.position_after), positions, 1.0, postures.size());
  return result;
}

double noiseSquares(const GapPosture& posture) {
  const Eigen::Index rows = posture.right.size() - posture.position_rows;
  return posture.noiseSquares(posture.position_rows, rows);
}

namespace {

/// Equations of some effects alone, with the recipes in their numbers: of fixed recipes all that is fitted.
struct Narrowed {
  SystemInput input;
  GapFit fit;
  std::vector<FitRecipe> recipes;
};

GapPosture narrowed(const GapPosture& posture, const std::vector<Eigen::Index>& columns, Eigen::Index end) {
  GapPosture own;
  own.columns = posture.columns(Eigen::all, columns);
  own.right = posture.right;
  own.position_rows = posture.position_rows;
  own.noise = posture.noise;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(end + 1, end + 1);
  posture.normal.addTo(1.0, normal);
  std::vector<Eigen::Index> both = columns;
  both.push_back(end);
  own.normal = numerics::LowerTriangle(normal(both, both));
  return own;
}

Narrowed narrowed(const SystemInput& input, const GapFit& fit, const std::vector<FitRecipe>& recipes) {
  Narrowed own{input, {}, recipes};
  own.input.models.clear();
  std::vector<Eigen::Index> columns(static_cast<std::size_t>(fit.data->layout.effects));
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    bool taken = false;
    for (std::size_t r = 0; r < recipes.size(); ++r) {
      for (std::size_t k = 0; k < recipes[r].models.size(); ++k) {
        if (recipes[r].models[k].model != m) continue;
        own.recipes[r].models[k].model = own.input.models.size();
        taken = true;
      }
    }
    if (!taken) continue;
    own.input.models.push_back(input.models[m]);
    for (std::size_t k = 0; k < input.models[m].parameters(); ++k)
      columns.push_back(fit.data->layout.model_at[m] + static_cast<Eigen::Index>(k));
  }
  const Eigen::Index end = fit.data->layout.end;
  own.fit.rules = fit.rules;
  own.fit.rules.given.clear();
  LinearSystem data;
  data.layout = gapLayout(own.input.models, input.campaign.robot, input.campaign.targets.size());
  for (const GapPosture& posture : fit.data->postures) data.postures.push_back(narrowed(posture, columns, end));
  columns.push_back(end);
  data.sweeps = fit.data->sweeps(columns, columns);
  own.fit.data = std::make_shared<const LinearSystem>(std::move(data));
  return own;
}

std::vector<HeldOutShrink> shrinks(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                                   const std::vector<bool>& allowed, const std::vector<FitRecipe>& recipes,
                                   int resamples, std::uint64_t seed) {
  const std::size_t postures = fit.data->postures.size();
  std::vector<HeldOutShrink> result(recipes.size());
  if (postures < kFewestHeldOut) {
    std::fill(result.begin(), result.end(), notJudged());
    return result;
  }
  std::vector<std::vector<HeldOut>> left(postures, std::vector<HeldOut>(recipes.size()));
  trainOnEach(input, alone, fit, allowed, recipes, othersOfEach(postures),
              [&](std::size_t p, const std::vector<Trained>& trained) {
                for (std::size_t r = 0; r < recipes.size(); ++r)
                  left[p][r] =
                      leftIn(alone.data->postures[p], trained[r].before, fit.data->postures[p], trained[r].after);
              });
  std::mt19937_64 random(seed);
  std::vector<numerics::Weights> samples(static_cast<std::size_t>(resamples));
  double judged = 0.0;
  for (auto& weights : samples) {
    weights = numerics::drawWeights(random, postures);
    judged += static_cast<double>(std::count(weights.begin(), weights.end(), 0.0));
  }
  const double judged_share =
      resamples > 0 ? judged / static_cast<double>(resamples) / static_cast<double>(postures) : 0.0;
  std::vector<std::vector<HeldOut>> drawn(samples.size(), std::vector<HeldOut>(recipes.size()));
  trainOnEach(input, alone, fit, allowed, recipes, samples, [&](std::size_t b, const std::vector<Trained>& trained) {
    const auto& weights = samples[b];
    for (std::size_t p = 0; p < postures; ++p) {
      if (weights[p] != 0.0) continue;
      for (std::size_t r = 0; r < recipes.size(); ++r)
        add(drawn[b][r], leftIn(alone.data->postures[p], trained[r].before, fit.data->postures[p], trained[r].after));
    }
  });
  double noise = 0.0;
  for (const GapPosture& posture : fit.data->postures) noise += noiseSquares(posture);
  for (std::size_t r = 0; r < recipes.size(); ++r) {
    HeldOut sum;
    for (const auto& one : left) add(sum, one[r]);
    std::vector<double> deflections, positions;
    for (const auto& one : drawn) {
      if (one[r].deflection_before > 0.0)
        deflections.push_back(shrinkOf(one[r].deflection_before, one[r].deflection_after));
      if (one[r].position_before > 0.0) positions.push_back(shrinkOf(one[r].position_before, one[r].position_after));
    }
    result[r].deflection =
        withInterval(shrinkOf(sum.deflection_before, sum.deflection_after), deflections, judged_share, postures);
    result[r].position =
        withInterval(shrinkOf(sum.position_before, sum.position_after), positions, judged_share, postures);
    const double gap = sum.deflection_before - noise;
    result[r].explained =
        gap > 0.05 * noise ? std::clamp((sum.deflection_before - sum.deflection_after) / gap, -1.0, 1.0) : 0.0;
  }
  return result;
}

}  // namespace

std::vector<Eigen::VectorXd> parametersWithoutEach(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                                                   const std::vector<bool>& allowed) {
  const std::size_t postures = fit.data->postures.size();
  std::vector<Eigen::VectorXd> parameters(postures);
  trainOnEach(input, alone, fit, allowed, {{true, {}}}, othersOfEach(postures),
              [&](std::size_t p, const std::vector<Trained>& trained) { parameters[p] = trained.front().after; });
  return parameters;
}

std::vector<HeldOutShrink> heldOutShrinks(const SystemInput& input, const GapFit& alone, const GapFit& fit,
                                          const std::vector<bool>& allowed, const std::vector<FitRecipe>& recipes,
                                          int resamples, std::uint64_t seed) {
  if (recipes.empty()) return {};
  const auto chooses = [](const FitRecipe& recipe) { return recipe.choose; };
  if (std::any_of(recipes.begin(), recipes.end(), chooses))
    return shrinks(input, alone, fit, allowed, recipes, resamples, seed);
  const Narrowed own = narrowed(input, fit, recipes);
  const std::vector<bool> all(own.input.models.size(), true);
  return shrinks(own.input, alone, own.fit, all, own.recipes, resamples, seed);
}

}  // namespace stiffscope::diagnosis
