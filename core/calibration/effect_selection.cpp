#include "core/calibration/effect_selection.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/calibration/family_fit.h"
#include "core/numerics/parallel.h"

namespace stiffscope::calibration {

namespace {

/// Some effects of the vocabulary beside the geometry.
struct EffectSet {
  std::vector<std::size_t> families;  ///< in the order in which they were found
  LinearModel model;
};

class Search {
 public:
  /// On so many postures and with so many parts of one effect at most.
  Search(const UnloadedDay& day, const ArmFit& geometry, std::size_t postures, int parts,
         const SelectionOptions& options)
      : options_(options),
        day_(day, geometry,
             {postures, options.inner_folds, options.inner_fold, options.outer_folds, options.outer_fold}),
        fits_(day_, options.chance, parts) {}

  /// From nothing and from the best single effects, by every kind of step.
  EffectSet best() {
    const EffectSet nothing{{}, day_.geometryAlone()};
    setEquations(nothing.model);
    std::vector<EffectSet> singles;
    for (auto& one : withEach(nothing, others(nothing))) {
      if (one) singles.push_back(std::move(*one));
    }
    std::sort(singles.begin(), singles.end(),
              [&](const EffectSet& a, const EffectSet& b) { return cost(a) < cost(b); });
    constexpr std::size_t kStarts = 3;
    singles.resize(std::min(singles.size(), kStarts));
    std::vector<EffectSet> ends{nothing};
    for (EffectSet& start : singles) {
      if (predicts(nothing, start)) ends.push_back(improved(std::move(start)));
    }
    // The least scatter of all says what the equations are worth.
    const auto leastScatter = [&]() -> const EffectSet& {
      return *std::min_element(ends.begin(), ends.end(), [](const EffectSet& a, const EffectSet& b) {
        return a.model.squares() < b.model.squares();
      });
    };
    setEquations(leastScatter().model);
    if (auto other = beforePeriodic(leastScatter())) ends.push_back(improved(std::move(*other)));
    setEquations(leastScatter().model);
    return *std::min_element(ends.begin(), ends.end(),
                             [&](const EffectSet& a, const EffectSet& b) { return cost(a) < cost(b); });
  }

  /// The same effects on these postures, each with the parts that they show, and what else they show.
  EffectSet refined(const EffectSet& found) {
    EffectSet set{{}, day_.geometryAlone()};
    setEquations(set.model);
    const auto fitAll = [&] {
      const std::vector<std::size_t> families = set.families.empty() ? found.families : set.families;
      for (const std::size_t family : families) {
        const EffectSet others = without(set, {family});
        auto anew = with(others, family, fits_.productsOf(others.model));
        set = anew ? std::move(*anew) : others;
        setEquations(set.model);
      }
    };
    fitAll();
    // The first were fitted without those after them, of which they then have taken what looks like them.
    if (set.families.size() > 1) fitAll();
    const std::size_t at_first = set.families.size();
    FamilyFit::Products beside = fits_.productsOf(set.model);
    for (std::size_t f = 0; f < fits_.families().size(); ++f) {
      if (has(set, f)) continue;
      auto more = with(set, f, beside);
      if (!more || cost(*more) >= cost(set) || !predicts(set, *more)) continue;
      set = std::move(*more);
      setEquations(set.model);
      beside = fits_.productsOf(set.model);
    }
    if (set.families.size() > at_first) fitAll();
    return set;
  }

  SelectedEffects described(const EffectSet& set) {
    setEquations(set.model);
    SelectedEffects selected;
    selected.parts = set.model.parts;
    const LinearModel nothing = day_.geometryAlone();
    selected.before = day_.heldOutByPosture(nothing);
    selected.before_by_division = byDivision(nothing);
    selected.after_by_division = byDivision(set.model);
    for (const std::vector<std::size_t>& group : explainingTheSame(set))
      selected.effects.push_back(describedOne(set, group));
    std::stable_sort(selected.effects.begin(), selected.effects.end(),
                     [](const SelectedEffect& a, const SelectedEffect& b) { return a.score > b.score; });
    for (std::size_t f = 0; f < fits_.families().size(); ++f) {
      const double fall = kPriceOfEffect + fits_.leastPenalty(f);
      // Of what is then left: each equation's share of the fall.
      selected.detectable.emplace_back(fits_.families()[f].effect, std::sqrt(std::expm1(fall / equations_)));
    }
    return selected;
  }

 private:
  UnloadedEffect effectOf(std::size_t family) const { return fits_.families()[family].effect; }

  bool isOf(const std::vector<std::size_t>& families, const EffectPart& part) const {
    return std::any_of(families.begin(), families.end(),
                       [&](std::size_t family) { return effectOf(family) == part.effect; });
  }

  /// Effects that the set lacks and that do as well in the place of what `rest` has less.
  void addRivals(const EffectSet& set, const EffectSet& rest, std::vector<Rival>& rivals) const {
    for (const auto& instead : withEach(rest, others(set))) {
      if (!instead || cost(*instead) - cost(set) > kAsGood) continue;
      rivals.push_back(
          {effectOf(instead->families.back()), instead->model.parts.back().detail, cost(*instead) - cost(set)});
    }
  }

  /// Those in the place of what is slow of one joint's periodic errors: over the angles at which a joint stands a wave
  /// of a turn or half a turn may be what a ratio does, or its own weight.
  void addRivalsOfSlow(const EffectSet& set, std::vector<Rival>& rivals) const {
    constexpr double kSlow = 2.0;  // waves a turn
    const auto isSlow = [](const EffectPart& part) { return part.order && *part.order <= kSlow; };
    std::set<std::string> joints;
    for (const EffectPart& part : set.model.parts) {
      if (isSlow(part)) joints.insert(part.detail);
    }
    for (const std::string& joint : joints) {
      const auto stays = [&](const EffectPart& part) { return !isSlow(part) || part.detail != joint; };
      addRivals(set, {set.families, day_.keeping(set.model, stays)}, rivals);
    }
  }

  /// The set's families, those together that explain the same, of which the one is first that is missed most.
  std::vector<std::vector<std::size_t>> explainingTheSame(const EffectSet& set) const {
    constexpr double kShared = 0.75;  // of what two take away
    const double all = set.model.squares();
    std::vector<std::vector<std::size_t>> groups;
    std::vector<double> own;
    for (const std::size_t family : set.families) own.push_back(without(set, {family}).model.squares() - all);
    const auto same = [&](std::size_t a, std::size_t b) {
      const double both = without(set, {set.families[a], set.families[b]}).model.squares() - all;
      return own[a] + own[b] < (1.0 - kShared) * both;
    };
    std::vector<std::size_t> order(set.families.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return own[a] > own[b]; });
    for (const std::size_t k : order) {
      const auto group =
          std::find_if(groups.begin(), groups.end(), [&](const auto& one) { return same(one.front(), k); });
      if (group != groups.end()) {
        group->push_back(k);
      } else {
        groups.push_back({k});
      }
    }
    for (auto& group : groups) {
      for (std::size_t& k : group) k = set.families[k];
    }
    return groups;
  }

  SelectedEffect describedOne(const EffectSet& set, const std::vector<std::size_t>& group) const {
    const EffectSet others = without(set, group);
    SelectedEffect one;
    one.effect = effectOf(group.front());
    for (std::size_t k = 1; k < group.size(); ++k) one.together.push_back(effectOf(group[k]));
    for (const EffectPart& part : set.model.parts) {
      if (part.effect == one.effect && one.detail.find(part.detail) == std::string::npos)
        one.detail += (one.detail.empty() ? "" : ", ") + part.detail;
    }
    one.score = cost(others) - cost(set);
    const double rows = static_cast<double>(day_.rows());
    one.size = day_.noise() * std::sqrt(std::max(0.0, others.model.squares() - set.model.squares()) / rows);
    addRivals(set, others, one.rivals);
    if (one.effect == UnloadedEffect::transmission_error) addRivalsOfSlow(set, one.rivals);
    std::sort(one.rivals.begin(), one.rivals.end(), [](const Rival& a, const Rival& b) { return a.cost < b.cost; });
    std::vector<Rival> each;
    for (Rival& rival : one.rivals) {
      const auto same = [&](const Rival& other) { return other.effect == rival.effect; };
      if (std::none_of(each.begin(), each.end(), same)) each.push_back(std::move(rival));
    }
    one.rivals = std::move(each);
    const LinearModel alone = day_.keeping(set.model, [&](const EffectPart& part) { return isOf(group, part); });
    one.held_out = day_.heldOutByPosture(alone);
    one.by_division = byDivision(alone);
    return one;
  }

  std::vector<double> byDivision(const LinearModel& model) const {
    return options_.divisions > 0 ? day_.heldOutByDivision(model, options_.divisions) : std::vector<double>();
  }

  void setEquations(const LinearModel& model) {
    const double rows = static_cast<double>(day_.rows() - day_.geometry().cols());
    equations_ = std::max(1.0, rows / day_.designEffect(model.residual));
  }

  double cost(const EffectSet& set) const {
    return FamilyFit::paid(set.model, equations_) + kPriceOfEffect * static_cast<double>(set.families.size()) -
           FamilyFit::fall(1.0, set.model.squares(), equations_);
  }

  static bool has(const EffectSet& set, std::size_t family) {
    return std::find(set.families.begin(), set.families.end(), family) != set.families.end();
  }

  /// Families that a set does not have.
  std::vector<std::size_t> others(const EffectSet& set) const {
    std::vector<std::size_t> families;
    for (std::size_t f = 0; f < fits_.families().size(); ++f) {
      if (!has(set, f)) families.push_back(f);
    }
    return families;
  }

  std::optional<EffectSet> with(const EffectSet& set, std::size_t family, const FamilyFit::Products& beside) const {
    auto model = fits_.fit(family, set.model, beside, equations_);
    if (!model) return std::nullopt;
    EffectSet more{set.families, std::move(*model)};
    more.families.push_back(family);
    return more;
  }

  /// The set with each of some families, one by one.
  std::vector<std::optional<EffectSet>> withEach(const EffectSet& set, const std::vector<std::size_t>& families) const {
    const FamilyFit::Products beside = fits_.productsOf(set.model);
    std::vector<std::optional<EffectSet>> sets(families.size());
    numerics::onAllCores(families.size(), [&](std::size_t k) { sets[k] = with(set, families[k], beside); });
    return sets;
  }

  /// The others with the parts that they have.
  EffectSet without(const EffectSet& set, const std::vector<std::size_t>& gone) const {
    EffectSet others{{}, day_.geometryAlone()};
    for (const std::size_t other : set.families) {
      if (std::find(gone.begin(), gone.end(), other) == gone.end()) others.families.push_back(other);
    }
    others.model = day_.keeping(set.model, [&](const EffectPart& part) { return !isOf(gone, part); });
    return others;
  }

  /// The best set in which an effect that the set lacks stands before its periodic errors, which then explain what it
  /// leaves; nothing where none is better than the set.
  std::optional<EffectSet> beforePeriodic(const EffectSet& set) const {
    const auto periodic = std::find_if(set.families.begin(), set.families.end(), [&](std::size_t family) {
      return effectOf(family) == UnloadedEffect::transmission_error;
    });
    if (periodic == set.families.end()) return std::nullopt;
    const std::vector<std::size_t> lacking = others(set);
    const EffectSet rest = without(set, {*periodic});
    const FamilyFit::Products beside = fits_.productsOf(rest.model);
    std::vector<std::optional<EffectSet>> found(lacking.size());
    numerics::onAllCores(lacking.size(), [&](std::size_t k) {
      const auto first = with(rest, lacking[k], beside);
      if (!first) return;
      found[k] = with(*first, *periodic, fits_.productsOf(first->model));
    });
    std::optional<EffectSet> best;
    for (auto& one : found) {
      if (one && cost(*one) < (best ? cost(*best) : cost(set)) - kSame) best = std::move(one);
    }
    return best;
  }

  /// Whether the larger set predicts postures better that were left out.
  bool predicts(const EffectSet& fewer, const EffectSet& more) const {
    return day_.heldOut(more.model) < (1.0 - options_.least_gain) * day_.heldOut(fewer.model);
  }

  /// Step by step to the best in reach.
  EffectSet improved(EffectSet set) {
    constexpr int kMostSteps = 20;
    for (int step = 0; step < kMostSteps; ++step) {
      setEquations(set.model);
      const double now = cost(set);
      std::optional<EffectSet> best;
      // `added_to`: the set beside which the candidate's last effect has to predict.
      const auto consider = [&](std::optional<EffectSet> candidate, const EffectSet* added_to) {
        if (!candidate || !(cost(*candidate) < (best ? cost(*best) : now) - kSame)) return;
        if (added_to != nullptr && !predicts(*added_to, *candidate)) return;
        best = std::move(candidate);
      };
      for (auto& more : withEach(set, others(set))) consider(std::move(more), &set);
      for (const std::size_t family : set.families) {
        EffectSet fewer = without(set, {family});
        for (auto& instead : withEach(fewer, others(fewer))) consider(std::move(instead), &fewer);
        consider(std::move(fewer), nullptr);
      }
      if (!best) break;
      set = std::move(*best);
    }
    return set;
  }

  static constexpr double kSame = 1e-6;

  const SelectionOptions& options_;
  LinearisedDay day_;
  FamilyFit fits_;
  double equations_ = 1.0;
};

}  // namespace

SelectedEffects selectEffects(const UnloadedDay& day, const ArmFit& geometry, const SelectionOptions& options) {
  if (day.postures.size() < kFewestForEffects) return {};
  const bool enough = day.postures.size() <= options.search_postures;
  Search search(day, geometry, options.search_postures, enough ? options.most_parts : options.search_parts, options);
  const EffectSet found = search.best();
  if (enough) return search.described(found);
  Search all(day, geometry, options.most_postures, options.most_parts, options);
  return all.described(all.refined(found));
}

}  // namespace stiffscope::calibration
