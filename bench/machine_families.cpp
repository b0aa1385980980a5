#include "bench/machine_families.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <variant>

#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "core/numerics/random.h"
#include "core/simulation/measure.h"
#include "core/simulation/postures.h"
#include "core/validation/effect_draw.h"
#include "core/validation/effect_size.h"

namespace stiffscope::bench {

namespace {

constexpr double kMassSigma = 0.05, kScaleSigma = 5e-5, kAngleSigma = 0.5 * io::kDegree, kPointSigma = 3e-3;

bool isDeclared(const std::string& family) {
  return family == "gain" || family == "cell_angles" || family == "cell_point" || family == "masses" ||
         family == "scale";
}

double logUniform(numerics::RandomStream& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

/// Bearings and links as real arms have them, at half their usual size: what tilts and bends is six to fifteen, three
/// to eight times stiffer than the drives.
void addBearingsAndLinks(numerics::RandomStream& random, simulation::MachineSpec& machine) {
  for (simulation::JointStiffness& joint : machine.joints) joint.bearing = *joint.torsion * logUniform(random, 12, 30);
  for (const int joint : {1, 2}) {
    simulation::LinkBeam beam;
    beam.joint = joint;
    constexpr double kLength = 1.0;  // m
    const double rate = *machine.joints[static_cast<std::size_t>(joint)].torsion * kLength;
    beam.bending = rate * logUniform(random, 6, 16);
    beam.torsion = rate * logUniform(random, 6, 16);
    std::erase_if(machine.links, [&](const simulation::LinkBeam& one) { return one.joint == joint; });
    machine.links.push_back(beam);
  }
  std::sort(machine.links.begin(), machine.links.end(),
            [](const simulation::LinkBeam& a, const simulation::LinkBeam& b) { return a.joint < b.joint; });
}

void addBaseAndFriction(numerics::RandomStream& random, simulation::SimulationSpec& spec) {
  simulation::MachineSpec& machine = spec.machine;
  machine.base_rotation = Eigen::Vector3d::Constant(*machine.joints[1].torsion * logUniform(random, 16, 40));
  for (int j = 0; j < static_cast<int>(machine.joints.size()); ++j) {
    simulation::JointStiffness& joint = machine.joints[static_cast<std::size_t>(j)];
    simulation::JointFriction friction;
    friction.torque = logUniform(random, 0.0025, 0.01) * validation::usualTorque(spec, j);
    friction.rate = *joint.torsion;
    joint.friction = friction;
  }
}

std::string familyOf(const std::string& family_at_kind) { return family_at_kind.substr(0, family_at_kind.find('@')); }

validation::MachineKind kindOf(const std::string& family_at_kind) {
  const std::size_t at = family_at_kind.find('@');
  if (at == std::string::npos) return validation::MachineKind::six_axis;
  const auto kind = validation::machineKindOf(family_at_kind.substr(at + 1));
  if (!kind) throw std::invalid_argument("no kind of machine is called " + family_at_kind.substr(at + 1));
  return *kind;
}

}  // namespace

validation::BlindCase drawMachine(const std::string& family_at_kind, int i, std::uint64_t seed,
                                  const std::filesystem::path& urdf) {
  const std::string family = familyOf(family_at_kind);
  using validation::CaseKind;
  validation::CasePlan plan;
  const std::vector<std::string>& effects = validation::loadedDays(kindOf(family_at_kind)).vocabulary.effects;
  const auto effect = [&](int k) { return effects[static_cast<std::size_t>(k) % effects.size()]; };
  if (family == "single") {
    plan = {CaseKind::single, {effect(i)}, {}};
  } else if (family == "double") {
    const int other = i + 1 + (i / static_cast<int>(effects.size()) * 5) % 15;
    plan = {CaseKind::pair, {effect(i), effect(other)}, {}};
  } else if (family == "outside") {
    const auto kinds = validation::outsideKinds();
    plan = {CaseKind::outside, {}, std::string(kinds[static_cast<std::size_t>(i) % kinds.size()])};
  }
  validation::BlindCase one = validation::drawCase(plan, seed, fmt::format("{} {}", family, i), urdf,
                                                   validation::loadedDays(kindOf(family_at_kind)));
  numerics::RandomStream random(seed, "as they are");
  if (family == "clean" || isDeclared(family)) {
    for (simulation::JointStiffness& joint : one.spec.machine.joints) joint.bearing.reset();
    one.spec.machine.links.clear();
  }
  if (family == "bearings_links" || family == "as_they_are") addBearingsAndLinks(random, one.spec.machine);
  if (family == "as_they_are") addBaseAndFriction(random, one.spec);
  if (family == "gain") {
    one.spec.load_cell->declared.gain_sigma = 0.01;
    one.spec.load_cell->gain_error = 0.01 * random.normal();
  }
  if (family == "cell_angles") {
    one.spec.load_cell->declared.angle_sigma = kAngleSigma;
    one.spec.load_cell->misalignment = kAngleSigma * random.normal3();
  }
  if (family == "cell_point") {
    one.spec.load_cell->declared.point_sigma = kPointSigma;
    one.spec.load_cell->place_error = kPointSigma * random.normal3();
  }
  if (family == "scale") {
    one.spec.tracker.declared.scale_sigma = kScaleSigma;
    one.spec.station.scale = kScaleSigma * random.normal();
  }
  return one;
}

double hangWeights(simulation::LoadingSpec& loading) {
  constexpr double kGravity = 9.80665;
  if (const auto* cable = std::get_if<simulation::CablePull>(&loading.load)) {
    simulation::HangingWeights weights;
    for (const double tension : cable->tensions) weights.masses_kg.push_back(tension / kGravity);
    loading.load = weights;
  }
  const auto& masses = std::get<simulation::HangingWeights>(loading.load).masses_kg;
  return kGravity * *std::max_element(masses.begin(), masses.end());
}

std::vector<JointVector> heldOutPostures(simulation::SimulationSpec spec, int count, double least_sin_bend) {
  simulation::PostureDraw draw(spec.nominal.joints());
  draw.count = count;
  draw.low = draw.high = spec.postures.front().q;
  for (const simulation::ListedPosture& one : spec.postures) {
    draw.low = draw.low.cwiseMin(one.q);
    draw.high = draw.high.cwiseMax(one.q);
  }
  draw.min_abs_sin_bend = least_sin_bend;
  spec.seed += 0x5eed;
  spec.postures.clear();
  spec.posture_draw = draw;
  std::vector<JointVector> postures;
  for (const simulation::Posture& one : simulation::loadingPostures(spec)) postures.push_back(one.q);
  return postures;
}

campaign::Campaign dayOf(const std::string& family, const validation::BlindCase& one, std::uint64_t seed) {
  campaign::Campaign campaign = simulation::simulate(one.spec);
  if (family != "masses") return campaign;
  numerics::RandomStream random(seed, "masses of the URDF");
  const double factor = 1.0 / (1.0 + kMassSigma * random.normal());
  robot::scaleMasses(factor, campaign.robot);
  campaign.mass_sigma = kMassSigma;
  return campaign;
}

void onMachines(const std::string& bench, const std::string& family, int count, std::uint64_t base,
                const std::function<void(int i, std::uint64_t seed, validation::BlindCase& one)>& judge) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("{}_{}", bench, base);
  std::filesystem::create_directories(folder);
  std::mutex mutex;
  numerics::onAllCores(static_cast<std::size_t>(count), [&](std::size_t machine) {
    const int i = static_cast<int>(machine);
    try {
      const std::uint64_t seed = base * 1'000'000 + machine;
      validation::BlindCase one = drawMachine(family, i, seed, folder / fmt::format("{}_{}.urdf", family, i));
      judge(i, seed, one);
    } catch (const std::exception& error) {
      const std::lock_guard<std::mutex> lock(mutex);
      std::cerr << family << ' ' << i << ": " << error.what() << '\n';
    }
  });
}

std::string effectsOf(const validation::BlindCase& one) {
  std::string effects;
  for (const validation::PlacedEffect& effect : one.effects)
    effects += (effect.effect.empty() ? std::string("outside") : effect.effect) + " " + effect.detail + ";";
  return effects;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace stiffscope::bench
