#include "core/validation/case.h"

#include <array>
#include <memory>
#include <stdexcept>

#include "core/effects/all.h"
#include "core/validation/effect_size.h"

namespace stiffscope::validation {

namespace {

effects::Effect knownEffect(const std::string& id) {
  const std::optional<effects::Effect> effect = effects::effectOf(id);
  if (!effect) throw std::invalid_argument("no effect is called '" + id + "'");
  return *effect;
}

template <class Sizer>
Sizing sizingBy(const simulation::SimulationSpec& clean) {
  const auto sizer = std::make_shared<const Sizer>(clean);
  return {[sizer](const simulation::SimulationSpec& with) { return sizer->measure(with); }, sizer->background()};
}

DayKind loadedDaysOf(MachineKind machine) {
  DayKind kind;
  const bool on_rail = machine == MachineKind::rail;
  for (const std::string_view id : effects::kEffectIds) {
    if (effects::concerns(knownEffect(std::string(id)), on_rail)) kind.vocabulary.effects.emplace_back(id);
  }
  // A rail that bends gives at every position, here more and there less.
  if (on_rail) kind.vocabulary.brings = {{"rail_bending", {"base_compliance"}}};
  kind.vocabulary.outside = outsideKinds();
  kind.vocabulary.placed = {"joint_coupling", "target_motion"};
  kind.vocabulary.shrinks = "deflection";
  kind.as_is = {{"bearing_tilt", "link_compliance", "base_compliance", "hysteresis"},
                {"bearing_tilt", "link_compliance"}};
  kind.machine = [machine](std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file) {
    return drawMachineOfKind(machine, seed, name, urdf_file);
  };
  kind.effect = [](const std::string& id, const auto& machine, auto& random) {
    return drawEffect(knownEffect(id), machine, random);
  };
  kind.outside = drawOutside;
  kind.as_is_effect = [](const std::string& id, const auto& machine, auto& random) {
    return drawAsIs(knownEffect(id), machine, random);
  };
  kind.sizing = sizingBy<EffectSizer>;
  return kind;
}

}  // namespace

const DayKind& loadedDays(MachineKind kind) {
  static const auto days = [] {
    std::array<DayKind, kMachineKindNames.size()> all;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = loadedDaysOf(static_cast<MachineKind>(k));
    return all;
  }();
  return days[static_cast<std::size_t>(kind)];
}

const DayKind& unloadedDays() {
  static const DayKind days = [] {
    DayKind kind;
    kind.vocabulary.effects = unloadedEffects();
    kind.vocabulary.outside = unloadedOutsideKinds();
    kind.vocabulary.placed = {"transmission_error", "ratio_error", "target_motion"};
    kind.vocabulary.brings = {{"gravity_compensator", {"joint_compliance"}}};
    kind.vocabulary.shrinks = "positions";
    kind.machine = drawUnloadedMachine;
    kind.effect = drawUnloadedEffect;
    kind.outside = drawUnloadedOutside;
    kind.sizing = sizingBy<GeometrySizer>;
    return kind;
  }();
  return days;
}

}  // namespace stiffscope::validation
