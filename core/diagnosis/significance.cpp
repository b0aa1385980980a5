#include "core/diagnosis/verdict.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/diagnosis/geometry_columns.h"
#include "core/diagnosis/geometry_error.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

double chanceLimit(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed, int draws,
                   double false_alarm, std::uint64_t seed) {
  const Eigen::VectorXd scale =
      fit.projection.matrix.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  const SymmetricEigen scaled = symmetricEigen(scale.asDiagonal() * fit.projection.matrix * scale.asDiagonal());
  const Eigen::MatrixXd root =
      scale.cwiseInverse().unaryExpr([](double d) { return std::isfinite(d) ? d : 0.0; }).asDiagonal() *
      scaled.vectors * scaled.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> best;
  Projection noise = fit.projection;
  noise.chi2_none = 0.0;
  noise.by_effects.resize(0, 0);  // the data's own stiffnesses say nothing here
  GapFit plain;
  plain.data = fit.data;
  plain.rules = fit.rules;
  plain.rules.given.clear();
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd numbers(noise.right.size());
    for (double& number : numbers) number = normal(random);
    noise.right = root * numbers;
    const Selector selector = selectorOf(input, plain, noise, static_cast<double>(fit.data->postures.size()), allowed);
    const auto ranked = selector.ranked(selector.nothing());
    best.push_back(ranked.empty() ? 0.0 : -ranked.front().score());
  }
  if (best.empty()) return 0.0;
  std::sort(best.begin(), best.end());
  const auto at = static_cast<std::size_t>((1.0 - false_alarm) * static_cast<double>(best.size() - 1));
  return std::max(0.0, best[at]);
}

double sizeOfDrop(const GapFit& fit, double drop) {
  return std::sqrt(std::max(0.0, drop) / fit.rules.loading_rows) * fit.data->state_noise;
}

namespace {

/// Squares of the effects' columns as the measurement's own noise weighs them: without the error of the model and the
/// inflation of positions that the fit counts as noise.
Eigen::VectorXd weighedByMeasuring(const SystemInput& input, const GapFit& fit) {
  SystemState state = fit.state;
  if (state.model_error == 0.0 && state.position_inflation == 1.0 && state.sweep_inflation == 1.0)
    return fit.projection.before;
  state.model_error = 0.0;
  state.position_inflation = state.sweep_inflation = 1.0;
  GeometryColumns own;
  const LinearSystem data = linearSystem(input, state, {}, fit.by_geometry ? *fit.by_geometry : own);
  const Eigen::MatrixXd normal = sumOf(data, std::vector<double>(data.postures.size(), 1.0));
  return normal.diagonal().segment(data.layout.effects, data.layout.end - data.layout.effects);
}

}  // namespace

std::vector<DetectableSize> detectableSizes(const SystemInput& input, const GapFit& fit,
                                            const std::vector<bool>& allowed) {
  const double drop = std::max(fit.rules.least_drop, fit.rules.detect);
  const Eigen::VectorXd by_measuring = weighedByMeasuring(input, fit);
  std::vector<DetectableSize> detectable;
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    if (!effects::concerns(effect, input.campaign.robot.rail.has_value())) continue;
    std::vector<double> sizes;
    for (std::size_t m = 0; m < input.models.size(); ++m) {
      if (input.models[m].effect != effect || !allowed[m]) continue;
      Eigen::Index at = fit.data->layout.model_at[m] - fit.data->layout.effects;
      for (const effects::EffectPart& part : input.models[m].parts) {
        double kept = 0.0, seen = 0.0;  // by the fit's own noise, and against the measurement's
        for (std::size_t k = 0; k < part.most.size(); ++k, ++at) {
          if (!(fit.projection.before[at] > 0.0)) continue;
          kept = std::max(kept, fit.projection.matrix(at, at) / fit.projection.before[at]);
          seen = std::max(seen, fit.projection.matrix(at, at) / by_measuring[at]);
        }
        if (kept > fit.rules.kept_share) sizes.push_back(sizeOfDrop(fit, drop / seen));
      }
    }
    DetectableSize size{effect, std::nullopt};
    if (!sizes.empty()) {
      size.size = numerics::upperMedian(std::move(sizes));
    }
    if (effect == effects::Effect::kinematic_error && input.absolute) size.size = kGeometryTolerance;
    detectable.push_back(size);
  }
  return detectable;
}

}  // namespace stiffscope::diagnosis
