#include "core/diagnosis/confounding.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::diagnosis {

Projection withField(const Projection& projection, const Eigen::VectorXd& field) {
  Projection made;
  made.matrix = projection.matrix;
  made.before = projection.before;
  made.right = projection.matrix * field;
  made.chi2_none = field.dot(made.right);
  return made;
}

namespace {

double leftBy(const SystemInput& input, const GapFit& fit, const Projection& made,
              const std::vector<ChosenModel>& others, std::size_t model, const std::vector<bool>& allowed,
              double matters) {
  std::vector<bool> only(allowed.size(), false);
  only[model] = true;
  // No price for parts here: the question is what the effect can imitate at all.
  const Selector selector(input.models, fit.data->layout, made, 1.0, fit.rules, only);
  const FittedSet base = selector.fit(others);
  std::vector<ChosenModel> models = base.models;
  // At the shape where it has settled: a straight step from there leads where no passage, no grip is.
  std::vector<std::size_t> parts;
  for (std::size_t p = 0; p < input.models[model].parts.size(); ++p) {
    if (!input.models[model].parts[p].is_shape) parts.push_back(p);
  }
  double least = base.chi2;
  constexpr double kRough = 1e-6;  // far above what roughChi2 is off by
  const auto mayLeave = [&](double chi2) { return selector.roughChi2(models) <= chi2 + kRough * made.chi2_none; };
  if (input.models[model].most_parts >= parts.size()) {
    models.push_back({model, parts});
    return mayLeave(matters) ? std::min(least, selector.fit(models).chi2) : least;
  }
  for (const std::size_t p : parts) {
    models = base.models;
    models.push_back({model, {p}});
    if (!mayLeave(std::min(least, matters))) continue;
    const FittedSet set = selector.fit(models);
    if (set.plausible) least = std::min(least, set.chi2);
  }
  return least;
}

}  // namespace

double separation(const SystemInput& input, const GapFit& fit, const Projection& made,
                  const std::vector<ChosenModel>& others, std::size_t by_model, const std::vector<bool>& allowed,
                  double matters) {
  return std::max(0.0, leftBy(input, fit, made, others, by_model, allowed, matters));
}

std::vector<std::vector<effects::Effect>> designConfounding(const SystemInput& input, const GapFit& fit,
                                                            const std::vector<bool>& allowed) {
  std::vector<std::vector<effects::Effect>> groups;
  constexpr double kTwice = 4.0;  // twice the noise of one state's displacement, squared
  const double size = kTwice * fit.rules.loading_rows;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    if (!allowed[m]) continue;
    Eigen::Index at = fit.data->layout.model_at[m] - fit.data->layout.effects;
    for (const effects::EffectPart& part : input.models[m].parts) {
      Eigen::VectorXd field = Eigen::VectorXd::Zero(fit.projection.right.size());
      const auto count = static_cast<Eigen::Index>(part.most.size());
      for (Eigen::Index k = 0; k < count; ++k) {
        const double own = fit.projection.matrix(at + k, at + k);
        if (own > fit.rules.kept_share * fit.projection.before[at + k]) field[at + k] = std::sqrt(size / own);
      }
      at += count;
      const double norm = field.dot(fit.projection.matrix * field);
      if (norm <= 0.0) continue;
      field *= std::sqrt(size / norm);
      const Projection made = withField(fit.projection, field);
      std::vector<effects::Effect> group{input.models[m].effect};
      for (std::size_t other = 0; other < input.models.size(); ++other) {
        const effects::Effect effect = input.models[other].effect;
        if (!allowed[other] || std::find(group.begin(), group.end(), effect) != group.end()) continue;
        if (separation(input, fit, made, {}, other, allowed, kSeparated) < kSeparated) group.push_back(effect);
      }
      std::sort(group.begin(), group.end());
      if (group.size() > 1 && std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

}  // namespace stiffscope::diagnosis
