#include "core/validation/case.h"

#include <algorithm>
#include <cmath>

#include "core/io/input_error.h"

namespace stiffscope::validation {

namespace {

using numerics::RandomStream;

/// Order that makes every prefix mixed: Fisher and Yates.
template <class T>
void mix(std::vector<T>& list, numerics::RandomStream& random) {
  for (std::size_t i = list.size(); i > 1; --i) {
    std::swap(list[i - 1], list[static_cast<std::size_t>(drawIndex(static_cast<int>(i), random))]);
  }
}

/// The effects one after another, each as often as any other, in an order of their own every round.
class Rounds {
 public:
  explicit Rounds(int count) : order_(static_cast<std::size_t>(count)), at_(order_.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
  }
  int next(numerics::RandomStream& random) {
    if (at_ == order_.size()) {
      mix(order_, random);
      at_ = 0;
    }
    return order_[at_++];
  }

 private:
  std::vector<int> order_;
  std::size_t at_;
};

EffectSize tried(const EffectDraw& draw, double strength, const simulation::SimulationSpec& clean,
                 const Sizing& sizing) {
  simulation::SimulationSpec spec = clean;
  draw.apply(strength, spec);
  return sizing.measure(spec);
}

/// Draws until the effect can show on this machine: friction in an axis that no load turns cannot.
PlacedEffect place(const std::function<EffectDraw()>& draw, double size, simulation::SimulationSpec& spec,
                   const simulation::SimulationSpec& clean, const Sizing& sizing) {
  constexpr int kMostDraws = 8;
  constexpr double kEnough = 0.8;  // of the size sought
  std::optional<EffectDraw> best;
  PlacedEffect placed;
  double strength = 0.0;
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    EffectDraw drawn = draw();
    PlacedEffect now{drawn.effect, drawn.detail, drawn.shows, {}};
    const double found = strengthFor(drawn, clean, sizing, size, now.sizes);
    if (best && now.size() <= placed.size()) continue;
    best = std::move(drawn);
    placed = std::move(now);
    strength = found;
    if (placed.size() >= kEnough * size) break;
  }
  best->apply(strength, spec);
  return placed;
}

}  // namespace

const char* nameOf(CaseKind kind) {
  switch (kind) {
    case CaseKind::none:
      return "none";
    case CaseKind::single:
      return "single";
    case CaseKind::pair:
      return "double";
    case CaseKind::outside:
      return "outside";
    case CaseKind::as_is:
      return "as_is";
  }
  return "";
}

double sizeOf(const EffectSize& sizes, Shows shows) {
  switch (shows) {
    case Shows::deflection:
      return sizes.deflection;
    case Shows::nests:
      return sizes.nests;
    case Shows::positions:
      return sizes.positions;
    case Shows::geometry:
      return sizes.geometry;
  }
  return 0.0;
}

double PlacedEffect::size() const { return sizeOf(sizes, shows); }

std::vector<CasePlan> planCases(int count, std::uint64_t seed, double as_is_share, const DayKind& days) {
  const Vocabulary& known = days.vocabulary;
  numerics::RandomStream random(seed, "plan");
  const int none = (count + 2) / 5, pairs = count / 8, outside = count / 8;
  if (days.as_is.empty()) as_is_share = 0.0;
  const int as_is = std::min(static_cast<int>(count * as_is_share), count - none - pairs - outside);
  Rounds effects(static_cast<int>(known.effects.size())), kinds(static_cast<int>(known.outside.size()));
  const auto effect = [&](int index) { return known.effects[static_cast<std::size_t>(index)]; };
  std::vector<CasePlan> plans;
  for (int c = 0; c < count; ++c) {
    CasePlan plan;
    if (c < none) {
      plan.kind = CaseKind::none;
    } else if (c < none + pairs) {
      plan.kind = CaseKind::pair;
      const int first = effects.next(random);
      int second = effects.next(random);
      while (second == first) second = effects.next(random);
      plan.effects = {effect(first), effect(second)};
    } else if (c < none + pairs + outside) {
      plan.kind = CaseKind::outside;
      plan.outside = known.outside[static_cast<std::size_t>(kinds.next(random))];
    } else if (c < none + pairs + outside + as_is) {
      plan.kind = CaseKind::as_is;
      plan.effects = days.as_is[static_cast<std::size_t>(c) % days.as_is.size()];
    } else {
      plan.kind = CaseKind::single;
      plan.effects = {effect(effects.next(random))};
    }
    plans.push_back(plan);
  }
  mix(plans, random);
  return plans;
}

double strengthFor(const EffectDraw& draw, const simulation::SimulationSpec& clean, const Sizing& sizing, double size,
                   EffectSize& sizes) {
  constexpr int kMostTries = 14;
  constexpr double kNear = 0.1;
  double strength = 1e-3 * draw.most;
  double low = 0.0, high = draw.most;  // sizes found below and above the one sought
  bool above = false;
  double best = 0.0, best_miss = 1e300;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    double found = 0.0;
    EffectSize now;
    bool stands = true;
    try {
      now = tried(draw, strength, clean, sizing);
      found = sizeOf(now, draw.shows);
    } catch (const io::InputError&) {  // so strong that the machine does not carry its load
      stands = false;
    }
    const double miss = std::abs(std::log(std::max(found, 1e-9) / size));
    if (stands && miss < best_miss) {
      best = strength;
      best_miss = miss;
      sizes = now;
    }
    if (best_miss < kNear) break;
    if (!stands || found > size) {
      high = strength;
      above = true;
    } else {
      low = strength;
      if (strength >= draw.most) break;
    }
    // As if in proportion, but into what is left of the interval.
    double next = stands && found > 0.0 ? strength * std::clamp(size / found, 0.05, 30.0) : 10.0 * strength;
    if (above && (next <= low || next >= high)) next = low > 0.0 ? std::sqrt(low * high) : 0.3 * high;
    if (!above) next = std::min(std::max(next, 1.5 * low), draw.most);
    strength = next;
  }
  return best;
}

BlindCase drawCase(const CasePlan& plan, std::uint64_t seed, const std::string& name,
                   const std::filesystem::path& urdf_file, const DayKind& days) {
  MachineDraw machine = days.machine(seed, name, urdf_file);
  numerics::RandomStream random(seed, "effects");
  if (random.uniform() < 0.3) machine.spec.tracker.true_noise_factor = random.uniform(0.75, 1.25);

  BlindCase one;
  one.arm = machine.arm;
  one.loading = machine.loading;
  one.kind = plan.kind;
  const simulation::SimulationSpec clean = machine.spec;
  const Sizing sizing = days.sizing(clean);
  one.background = sizing.background;
  const double least = plan.kind == CaseKind::pair ? 2.0 : 0.5;
  const auto drawSize = [&] {
    const double size = least * std::pow(10.0 / least, random.uniform());
    return plan.size.value_or(size);
  };
  const auto placeAll = [&] {
    machine.spec = clean;
    one.effects.clear();
    for (const std::string& effect : plan.effects) {
      if (plan.kind == CaseKind::as_is) {
        const EffectDraw draw = days.as_is_effect(effect, clean, random);
        one.effects.push_back({effect, draw.detail, draw.shows, tried(draw, 1.0, clean, sizing)});
        draw.apply(1.0, machine.spec);
        continue;
      }
      const double size = drawSize();
      one.effects.push_back(
          place([&] { return days.effect(effect, clean, random); }, size, machine.spec, clean, sizing));
    }
    if (plan.kind == CaseKind::outside) {
      const double size = drawSize();
      one.effects.push_back(
          place([&] { return days.outside(plan.outside, clean, random); }, size, machine.spec, clean, sizing));
    }
    if (!one.effects.empty()) one.together = sizing.measure(machine.spec);
  };
  constexpr int kMostDraws = 10;
  for (int draws = 1;; ++draws) {
    try {
      placeAll();
      break;
    } catch (const io::InputError&) {  // each stands alone, and together the machine does not carry its load
      if (draws == kMostDraws) throw;
    }
  }
  one.spec = std::move(machine.spec);
  return one;
}

}  // namespace stiffscope::validation
