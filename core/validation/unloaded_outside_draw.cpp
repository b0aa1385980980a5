#include <array>
#include <cmath>
#include <stdexcept>

#include "core/io/units.h"
#include "core/validation/effect_draw.h"

namespace stiffscope::validation {

using Eigen::Vector3d;
using numerics::RandomStream;

namespace {

/// A dress pack from the forearm to the hand, which pulls the wrist's joints about: their own weight hardly does.
EffectDraw pullingCable(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto& axes = machine.nominal.axes_in_base_at_zero;
  const int last = machine.nominal.axes(), forearm = machine.nominal.armAxes();  // bodies
  const auto wrist = static_cast<std::size_t>(forearm);                          // its first joint
  const Vector3d from = axes[wrist - 1].point + Vector3d(-0.1, random.uniform(0.15, 0.3), 0.2);
  const Vector3d to = axes[static_cast<std::size_t>(last) - 2].point + Vector3d(0.1, random.uniform(-0.2, 0.2), 0.15);
  const double rate = random.uniform(0.5, 2.0);
  const double first = 20.0 * milliradianStiffness(machine, forearm);
  const double second = 20.0 * milliradianStiffness(machine, forearm + 1);
  EffectDraw draw;
  draw.most = 2e4;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in N
    if (s <= 0.0) return;
    spec.machine.joints[wrist].torsion = first;
    spec.machine.joints[wrist + 1].torsion = second;
    spec.machine.link_springs.push_back({forearm, last, from, to, s * rate, s});
  };
  return draw;
}

EffectDraw zeroByTemperature(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = 1 + drawIndex(machine.nominal.joints() - 2, random);  // neither the first nor the last
  const double day = dayLength(machine), lag = day * random.uniform(0.1, 0.3);
  const double begin = random.uniform(17.0, 25.0), top = begin + random.uniform(2.0, 6.0);
  EffectDraw draw;
  draw.most = 2e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in rad/K
    if (s <= 0.0) return;
    // Up, down and up again: what follows late is elsewhere each time.
    spec.temperature = {{0.0, 0.25 * day, 0.6 * day, day}, {begin, top, begin - 1.0, top}};
    spec.machine.joints[static_cast<std::size_t>(joint)].zero_warming = simulation::ZeroWarming{s, lag};
  };
  return draw;
}

EffectDraw loosePlate(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const Vector3d direction = (Vector3d::UnitX() + 0.3 * drawDirection(random)).normalized();
  const Vector3d shift = drawDirection(random), turn = drawDirection(random);
  EffectDraw draw;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m; the turn is as much at 0.3 m
    if (s > 0.0) spec.machine.loose_plate = simulation::LoosePlate{direction, s * shift, s / 0.3 * turn};
  };
  return draw;
}

EffectDraw layeredAir(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const double level = random.uniform(-1.0, 1.0);
  EffectDraw draw;
  draw.most = 1e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in 1/m^2
    spec.station.bending = s * level;
    spec.station.bending_per_m = s;
  };
  return draw;
}

EffectDraw rattlingReflector(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto which = static_cast<std::size_t>(drawIndex(static_cast<int>(machine.targets.size()), random));
  const Vector3d direction = drawDirection(random);
  EffectDraw draw;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m
    if (s <= 0.0) return;
    simulation::TargetMotion motion;
    motion.kind = simulation::TargetMotion::Kind::rattling;
    motion.shift = s * direction;
    spec.targets[which].motion = motion;
  };
  return draw;
}

EffectDraw slippedBelt(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = 1 + drawIndex(machine.nominal.joints() - 2, random);  // neither the first nor the last
  const double at_s = random.uniform(0.25, 0.75) * dayLength(machine);
  EffectDraw draw;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in rad
    if (s > 0.0) spec.machine.joints[static_cast<std::size_t>(joint)].zero_jump = simulation::ZeroJump{s, at_s};
  };
  return draw;
}

/// The pedestal rests on three sides of four: it gives where the arm leans to the fourth.
EffectDraw openCrack(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int axis = drawIndex(2, random);
  const bool positive = random.uniform() < 0.5;
  const double rate = milliradianStiffness(machine, 0);
  EffectDraw draw;
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    spec.machine.base_rotation = Vector3d::Constant(rate / s);
    for (const int about : {0, 1, 2}) {
      for (const bool side : {true, false}) {
        if (about == axis && side == positive) continue;
        spec.machine.base_contacts.push_back({about, side, 1000.0 * rate, 0.0});
      }
    }
  };
  return draw;
}

using DrawOne = EffectDraw (*)(const simulation::SimulationSpec&, numerics::RandomStream&);
const std::array<std::pair<const char*, DrawOne>, 7> kUnloadedKinds{{{"pulling_cable", pullingCable},
                                                                     {"zero_by_temperature", zeroByTemperature},
                                                                     {"loose_plate", loosePlate},
                                                                     {"layered_air", layeredAir},
                                                                     {"rattling_reflector", rattlingReflector},
                                                                     {"slipped_belt", slippedBelt},
                                                                     {"cracked_floor", openCrack}}};

}  // namespace

const std::vector<std::string>& unloadedOutsideKinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, draw] : kUnloadedKinds) all.emplace_back(name);
    return all;
  }();
  return names;
}

EffectDraw drawUnloadedOutside(const std::string& kind, const simulation::SimulationSpec& machine,
                               numerics::RandomStream& random) {
  for (const auto& [name, draw] : kUnloadedKinds) {
    if (name != kind) continue;
    EffectDraw effect = draw(machine, random);
    effect.detail = kind;
    effect.shows = Shows::positions;
    return effect;
  }
  throw std::invalid_argument("no effect outside the vocabulary of days without a load is called '" + kind + "'");
}

}  // namespace stiffscope::validation
