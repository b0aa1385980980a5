#include <array>
#include <numbers>
#include <stdexcept>

#include "core/io/units.h"
#include "core/validation/effect_draw.h"

namespace stiffscope::validation {

using Eigen::Vector3d;
using numerics::RandomStream;

namespace {

EffectDraw creep(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const double time = random.uniform(8.0, 40.0);
  EffectDraw draw;
  draw.most = 1.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) spec.machine.creep = simulation::Creep{std::min(s, 1.0), time};
  };
  return draw;
}

EffectDraw stiffnessRipple(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const int joint = drawIndex(3, random);
  const double cycles = 5.0 + drawIndex(5, random), phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  EffectDraw draw;
  draw.most = 0.9;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) {
      spec.machine.joints[static_cast<std::size_t>(joint)].rate_wave =
          simulation::JointWave{std::min(s, 0.9), cycles, phase};
    }
  };
  return draw;
}

EffectDraw warmingDrives(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const double time = random.uniform(2000.0, 8000.0);
  EffectDraw draw;
  draw.most = 0.8;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    for (auto& joint : spec.machine.joints) joint.softening = simulation::JointSoftening{std::min(s, 0.8), time};
  };
  return draw;
}

EffectDraw swingingLoad(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const double period = random.uniform(1.1, 1.9);
  EffectDraw draw;
  draw.most = 15.0 * io::kDegree;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    spec.loading->swing = s;
    spec.loading->swing_period = period;
  };
  return draw;
}

EffectDraw crackedFloor(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int axis = drawIndex(2, random);
  const bool positive = random.uniform() < 0.5;
  const double rate = 5.0 * *machine.machine.joints[1].torsion;
  EffectDraw draw;
  draw.most = 3.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    // The floor itself is stiff; what the crack takes away is found on one side only.
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

EffectDraw thermalGrowth(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = longestLinks(machine)[random.uniform() < 0.5 ? 1 : 0];
  const double time = random.uniform(2000.0, 10000.0);
  EffectDraw draw;
  draw.shows = Shows::positions;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) { spec.machine.growths = {{joint, s, time}}; };
  return draw;
}

EffectDraw eccentricEncoder(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = 1 + drawIndex(machine.nominal.joints() - 2, random);  // neither the first nor the last
  const double cycles = random.uniform() < 0.5 ? 1.0 : 2.0 + drawIndex(6, random);
  const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  EffectDraw draw;
  draw.shows = Shows::positions;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    spec.machine.joints[static_cast<std::size_t>(joint)].angle_wave = simulation::JointWave{s, cycles, phase};
  };
  return draw;
}

EffectDraw dressPack(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto& axes = machine.nominal.axes_in_base_at_zero;
  const int last = machine.nominal.axes(), forearm = machine.nominal.armAxes();  // bodies
  const Vector3d from =
      axes[static_cast<std::size_t>(forearm) - 1].point + Vector3d(-0.1, random.uniform(0.15, 0.3), 0.2);
  const Vector3d to = axes[static_cast<std::size_t>(last) - 2].point + Vector3d(0.05, random.uniform(-0.2, 0.2), 0.15);
  const double rate = random.uniform(0.5, 2.0);
  EffectDraw draw;
  draw.shows = Shows::positions;
  draw.most = 20000.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in N
    if (s > 0.0) spec.machine.link_springs.push_back({forearm, last - 1, from, to, s * rate, s});
  };
  return draw;
}

EffectDraw refraction(const simulation::SimulationSpec&, numerics::RandomStream& random) {
  const double constant = random.uniform(-0.5, 0.5);
  EffectDraw draw;
  draw.shows = Shows::nests;
  draw.most = 1e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    spec.station.scale = s * constant;
    spec.station.scale_per_second = s / 10000.0;
  };
  return draw;
}

using Draw = EffectDraw (*)(const simulation::SimulationSpec&, numerics::RandomStream&);
const std::array<std::pair<const char*, Draw>, 9> kKinds{{{"creep", creep},
                                                          {"stiffness_ripple", stiffnessRipple},
                                                          {"warming_drives", warmingDrives},
                                                          {"swinging_load", swingingLoad},
                                                          {"cracked_floor", crackedFloor},
                                                          {"thermal_growth", thermalGrowth},
                                                          {"eccentric_encoder", eccentricEncoder},
                                                          {"dress_pack", dressPack},
                                                          {"refraction", refraction}}};

}  // namespace

const std::vector<std::string>& outsideKinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, draw] : kKinds) all.emplace_back(name);
    return all;
  }();
  return names;
}

EffectDraw drawOutside(const std::string& kind, const simulation::SimulationSpec& machine,
                       numerics::RandomStream& random) {
  for (const auto& [name, draw] : kKinds) {
    if (name != kind) continue;
    EffectDraw effect = draw(machine, random);
    effect.detail = kind;
    return effect;
  }
  throw std::invalid_argument("no effect outside the vocabulary is called '" + kind + "'");
}

}  // namespace stiffscope::validation
