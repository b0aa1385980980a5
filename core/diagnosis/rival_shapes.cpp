#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/diagnosis/fit.h"
#include "core/numerics/parallel.h"

namespace stiffscope::diagnosis {

namespace {

/// The best of the sets that have the model in the place of one of the chosen, or beside them all, where it is worth
/// it there.
std::optional<FittedSet> inBestPlace(const SystemInput& input, const Selector& selector, const FittedSet& chosen,
                                     std::size_t model) {
  std::optional<FittedSet> best;
  for (std::size_t i = 0; i <= chosen.models.size(); ++i) {
    std::vector<ChosenModel> others = chosen.models;
    if (i < others.size()) {
      if (selector.isGiven(others[i].model)) continue;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    }
    const FittedSet base = selector.fit(others);
    if (base.has(input.models, input.models[model].effect)) continue;
    auto with = selector.grown(base, model);
    if (with && selector.worth(*with, base) && (!best || with->score() < best->score())) best = std::move(with);
  }
  return best;
}

}  // namespace

void settleRivals(const SystemInput& input, const GapFit& fit, const Selector& selector,
                  const std::vector<bool>& allowed, effects::LinearizationPoint& at) {
  using Settle = decltype(effects::EffectModel::settle);
  struct Rival {
    std::size_t model = 0;
    std::optional<FittedSet> set;
  };
  const auto settleOf = [&](std::size_t model) { return input.models[model].settle; };
  std::vector<Settle> of_chosen;
  for (const ChosenModel& one : fit.set.models) of_chosen.push_back(settleOf(one.model));
  std::vector<Rival> all;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const bool chosen = std::find(of_chosen.begin(), of_chosen.end(), settleOf(m)) != of_chosen.end();
    if (settleOf(m) != nullptr && allowed[m] && !chosen) all.push_back({m, {}});
  }
  numerics::onAllCores(all.size(),
                       [&](std::size_t k) { all[k].set = inBestPlace(input, selector, fit.set, all[k].model); });
  std::vector<Rival> rivals;  // of those that bend by the same numbers, the best
  for (Rival& one : all) {
    const auto same = std::find_if(rivals.begin(), rivals.end(),
                                   [&](const Rival& rival) { return settleOf(rival.model) == settleOf(one.model); });
    if (same == rivals.end()) {
      rivals.push_back(std::move(one));
    } else if (one.set && (!same->set || one.set->score() < same->set->score())) {
      *same = std::move(one);
    }
  }
  const GapLayout& layout = fit.data->layout;
  const JointVector compliance = at.compliance;
  for (const Rival& rival : rivals) {
    Eigen::VectorXd own = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(input.models[rival.model].parameters()));
    if (rival.set) {
      // Springs as they are with it and not with what was chosen.
      const Eigen::VectorXd nuisances = fit.projection.by_nothing - fit.projection.by_effects * rival.set->effects;
      at.compliance = nuisances.head(layout.joints()).cwiseMax(0.0);
      own = rival.set->effects.segment(layout.model_at[rival.model] - layout.effects, own.size());
    }
    settleOf(rival.model)(at, own);
    at.compliance = compliance;
  }
}

}  // namespace stiffscope::diagnosis
