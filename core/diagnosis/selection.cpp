#include "core/diagnosis/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/parallel.h"

namespace stiffscope::diagnosis {

bool FittedSet::has(const std::vector<effects::EffectModel>& table, effects::Effect effect) const {
  return std::any_of(models.begin(), models.end(),
                     [&](const ChosenModel& one) { return table[one.model].effect == effect; });
}

Selector::Selector(const std::vector<effects::EffectModel>& models, const GapLayout& layout,
                   const Projection& projection, double postures, const SelectionRules& rules,
                   const std::vector<bool>& allowed)
    : models_(models),
      layout_(layout),
      projection_(projection),
      postures_(postures),
      rules_(rules),
      allowed_(allowed),
      prior_(priorsOf(models)) {
  for (std::size_t m = 0; m < models.size(); ++m) {
    Eigen::Index at = layout.model_at[m] - layout.effects;
    part_at_.emplace_back();
    for (const effects::EffectPart& part : models[m].parts) {
      part_at_.back().push_back(at);
      at += static_cast<Eigen::Index>(part.most.size());
    }
  }
  given_chi2_ = given().chi2;
}

FittedSet Selector::nothing() const {
  FittedSet none;
  none.effects = Eigen::VectorXd::Zero(projection_.right.size());
  none.chi2 = projection_.chi2_none;
  return none;
}

/// Which model, and which of its parts, was looked for: a choice among so many. A shape that has settled takes no step
/// any more, and was a parameter all the same.
double Selector::penaltyOfModel(std::size_t model) const {
  const double shape = models_[model].shapeAt != nullptr ? std::log(postures_) : 0.0;
  return 2.0 * std::log(static_cast<double>(models_.size())) + shape;
}

double Selector::penaltyOfPart(std::size_t model, std::size_t parameters) const {
  return 2.0 * std::log(static_cast<double>(models_[model].parts.size())) +
         std::log(postures_) * static_cast<double>(parameters);
}

FittedSet Selector::fit(const std::vector<ChosenModel>& models) const {
  FittedSet set = nothing();
  set.models = models;
  std::vector<Eigen::Index> indices;
  std::vector<bool> positive, is_shape;
  for (const ChosenModel& one : models) {
    const effects::EffectModel& model = models_[one.model];
    set.penalty += penaltyOfModel(one.model);
    for (const std::size_t p : one.parts) {
      const effects::EffectPart& part = model.parts[p];
      set.penalty += penaltyOfPart(one.model, part.most.size());
      for (std::size_t k = 0; k < part.most.size(); ++k) {
        indices.push_back(part_at_[one.model][p] + static_cast<Eigen::Index>(k));
        positive.push_back(part.positive);
        is_shape.push_back(part.is_shape);
      }
    }
  }
  const SubsetFit fitted = fitSubset(projection_, indices, positive, prior_);
  set.chi2 -= fitted.drop;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const double value = fitted.value[static_cast<Eigen::Index>(i)];
    set.effects[indices[i]] = value;
    // A long step of a shape is taken in strides (EffectModel::settle).
    if (!is_shape[i] && value * value * prior_[indices[i]] > 1.0) set.plausible = false;
  }
  if (negativeCompliance(set, indices)) set.plausible = false;
  return set;
}

bool Selector::negativeCompliance(const FittedSet& set, const std::vector<Eigen::Index>& indices) const {
  if (projection_.by_effects.size() == 0) return false;
  constexpr double kSure = 4.0;       // standard deviations
  constexpr double kExplained = 2.0;  // chi2 per equation: with more left, stiffnesses are not to be judged
  if (misfit(set) > kExplained) return false;
  std::vector<Eigen::Index> present;
  for (const Eigen::Index i : indices) {
    if (set.effects[i] != 0.0) present.push_back(i);
  }
  for (Eigen::Index j = 0; j < layout_.joints(); ++j) {
    if (!rules_.loaded.empty() && !rules_.loaded[static_cast<std::size_t>(j)]) continue;
    const double compliance = projection_.by_nothing[j] - projection_.by_effects.row(j).dot(set.effects);
    if (compliance >= 0.0) continue;
    const double sd = std::sqrt(misfit(set)) * complianceSd(projection_, present, prior_, j);
    if (compliance < -kSure * sd) return true;
  }
  return false;
}

double Selector::misfit(const FittedSet& set) const {
  return std::max(1.0, (set.chi2 - rules_.other_rows) / rules_.loading_rows);
}

bool Selector::isGiven(std::size_t model) const {
  return std::find(rules_.given.begin(), rules_.given.end(), model) != rules_.given.end();
}

FittedSet Selector::given() const {
  std::vector<ChosenModel> models;
  for (const std::size_t m : rules_.given) {
    models.push_back({m, {}});
    for (std::size_t p = 0; p < models_[m].parts.size(); ++p) models.back().parts.push_back(p);
  }
  return fit(models);
}

bool Selector::isSeen(std::size_t model, std::size_t part) const {
  double kept = 0.0;
  for (std::size_t k = 0; k < models_[model].parts[part].most.size(); ++k) {
    const Eigen::Index i = part_at_[model][part] + static_cast<Eigen::Index>(k);
    if (projection_.before[i] > 0.0) kept = std::max(kept, projection_.matrix(i, i) / projection_.before[i]);
  }
  return kept >= rules_.kept_share;
}

void Selector::addPart(std::size_t model, std::size_t part, GrowingSubset& subset) const {
  const effects::EffectPart& one = models_[model].parts[part];
  for (std::size_t k = 0; k < one.most.size(); ++k)
    subset.add(part_at_[model][part] + static_cast<Eigen::Index>(k), one.positive);
}

GrowingSubset Selector::subsetOf(const std::vector<ChosenModel>& models) const {
  GrowingSubset subset(projection_, prior_);
  for (const ChosenModel& one : models) {
    for (const std::size_t part : one.parts) addPart(one.model, part, subset);
  }
  return subset;
}

double Selector::roughChi2(const std::vector<ChosenModel>& models) const {
  return projection_.chi2_none - subsetOf(models).drop();
}

/// The models with that part more of the last one which lowers chi2 most. `subset`: of the models.
std::optional<FittedSet> Selector::withBestPart(std::vector<ChosenModel> models, GrowingSubset& subset) const {
  std::vector<std::size_t>& parts = models.back().parts;
  const std::size_t model = models.back().model, common = subset.size();
  std::vector<std::size_t> candidates;
  for (std::size_t p = 0; p < models_[model].parts.size(); ++p) {
    if (std::find(parts.begin(), parts.end(), p) == parts.end() && isSeen(model, p)) candidates.push_back(p);
  }
  std::vector<double> drops;
  for (const std::size_t p : candidates) {
    addPart(model, p, subset);
    drops.push_back(subset.drop());
    subset.cutTo(common);
  }
  const double most = drops.empty() ? 0.0 : *std::max_element(drops.begin(), drops.end());
  constexpr double kNear = 1e-6;  // far above what `drops` are off by
  std::optional<FittedSet> best;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    // Parts that bring the same bring nothing, for they would have to be negative: the first stands for all.
    const bool repeats = std::find(drops.begin(), drops.begin() + static_cast<std::ptrdiff_t>(c), drops[c]) !=
                         drops.begin() + static_cast<std::ptrdiff_t>(c);
    if (repeats || drops[c] < most - kNear * most) continue;
    parts.push_back(candidates[c]);
    FittedSet tried = fit(models);
    parts.pop_back();
    if (!best || tried.chi2 < best->chi2) best = std::move(tried);
  }
  return best;
}

std::optional<FittedSet> Selector::grown(const FittedSet& base, std::size_t model) const {
  std::optional<FittedSet> best, plausible;
  GrowingSubset subset = subsetOf(base.models);
  std::vector<ChosenModel> models = base.models;
  models.push_back({model, {}});
  while (models.back().parts.size() < models_[model].most_parts) {
    std::optional<FittedSet> next = withBestPart(models, subset);
    if (!next) break;
    // What the whole set cannot explain counts as noise when a further part asks to be let in.
    if (best && (best->chi2 - next->chi2) / misfit(*next) <= next->penalty - best->penalty) break;
    best = std::move(next);
    models = best->models;
    addPart(model, models.back().parts.back(), subset);
    if (best->plausible) plausible = best;
  }
  return plausible;
}

/// Whether any parts of the model on top of `base` may: all that are seen, none of them bounded, bring as much as those
/// that would be chosen, and the smallest part alone costs as little.
bool Selector::mayScoreBelow(double limit, const FittedSet& base, std::size_t model) const {
  if (std::isinf(limit)) return true;
  const std::vector<effects::EffectPart>& parts = models_[model].parts;
  GrowingSubset subset = subsetOf(base.models);
  std::size_t smallest = std::numeric_limits<std::size_t>::max();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!isSeen(model, p)) continue;
    addPart(model, p, subset);
    smallest = std::min(smallest, parts[p].most.size());
  }
  if (smallest == std::numeric_limits<std::size_t>::max()) return false;  // nothing to choose from
  const double penalty = base.penalty + penaltyOfModel(model) + penaltyOfPart(model, smallest);
  constexpr double kRough = 1e-6;  // far above what mostDrop is off by
  return projection_.chi2_none * (1.0 - kRough) - subset.mostDrop() + penalty < limit;
}

std::vector<FittedSet> Selector::ranked(const FittedSet& base, double limit) const {
  std::vector<std::optional<FittedSet>> by_model(models_.size());
  numerics::onAllCores(models_.size(), [&](std::size_t m) {
    if (allowed_[m] && !base.has(models_, models_[m].effect) && mayScoreBelow(limit, base, m))
      by_model[m] = grown(base, m);
  });
  std::vector<FittedSet> sets;
  for (std::optional<FittedSet>& set : by_model) {
    if (set) sets.push_back(std::move(*set));
  }
  std::stable_sort(sets.begin(), sets.end(),
                   [](const FittedSet& a, const FittedSet& b) { return a.score() < b.score(); });
  return sets;
}

bool Selector::worth(const FittedSet& with, const FittedSet& without) const {
  const double scale = misfit(with);
  const double drop = without.chi2 - with.chi2;
  const double removed = given_chi2_ - with.chi2;
  return drop / scale - (with.penalty - without.penalty) > rules_.detect && drop > rules_.least_drop * scale &&
         drop > std::min(rules_.share_of_removed * removed, rules_.loading_rows);
}

FittedSet Selector::regrown(FittedSet set) const {
  for (std::size_t i = 0; i < set.models.size() && set.models.size() > 1; ++i) {
    if (isGiven(set.models[i].model)) continue;
    std::vector<ChosenModel> others = set.models;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto again = grown(fit(others), set.models[i].model);
    if (!again || again->score() >= set.score()) continue;
    set.models[i] = again->models.back();
    set = fit(set.models);
  }
  return set;
}

FittedSet Selector::pruned(FittedSet set) const {
  for (bool again = true; again && !set.models.empty();) {
    again = false;
    for (std::size_t i = 0; i < set.models.size(); ++i) {
      std::vector<ChosenModel> fewer = set.models;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      if (isGiven(set.models[i].model)) continue;
      FittedSet without = fit(fewer);
      if (worth(set, without)) continue;
      set = std::move(without);
      again = true;
      break;
    }
  }
  return set;
}

FittedSet Selector::select() const {
  FittedSet current = given();
  std::vector<FittedSet> singles;
  constexpr std::size_t kFew = 6;
  for (std::size_t count = 0; count < rules_.most_effects; ++count) {
    // A set that is worth it scores lower than this: see worth. Of the first, the next best are wanted too.
    double limit = current.score() - rules_.detect;
    std::optional<FittedSet> best;
    const auto take = [&](const std::vector<FittedSet>& sets) {
      if (sets.empty() || (best && sets.front().score() >= best->score())) return;
      best = sets.front();
      limit = std::min(limit, best->score());
    };
    if (count == 0) take(singles = ranked(current));
    if (count > 0) take(ranked(current, limit));
    if (count == 1) {
      // All pairs of the best few, single and second, may beat the forward pair.
      for (std::size_t a = 0; a < std::min(kFew, singles.size()); ++a) {
        if (singles[a].models != current.models) take(ranked(singles[a], limit));  // else seen already
      }
    }
    if (!best || !worth(*best, current)) break;
    current = pruned(regrown(std::move(*best)));
  }
  return current;
}

}  // namespace stiffscope::diagnosis
