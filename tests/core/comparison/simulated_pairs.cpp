#include "tests/core/comparison/simulated_pairs.h"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <numbers>
#include "core/numerics/random.h"
#include "core/validation/effect_draw.h"

namespace stiffscope::simulated_pairs {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::uint64_t seedOf(std::uint64_t first_seed, int pair) {
  return 1000 * first_seed + static_cast<std::uint64_t>(pair);
}

void hideBearingsAndLinks(numerics::RandomStream& random, simulation::SimulationSpec& spec) {
  for (simulation::JointStiffness& joint : spec.machine.joints) {
    joint.bearing = *joint.torsion * random.uniform(2.5, 6.0);
  }
  const auto& axes = spec.nominal.axes_in_base_at_zero;
  for (const int joint : {1, 3}) {
    const auto at = static_cast<std::size_t>(joint);
    const double length = (axes[at + 1].point - axes[at].point).norm();
    const double rigidity = *spec.machine.joints[std::min<std::size_t>(at, 2)].torsion * length * random.uniform(2, 5);
    spec.machine.links.push_back({joint, rigidity, rigidity / random.uniform(0.5, 2.0), std::nullopt, std::nullopt});
  }
}

}  // namespace

simulation::SimulationSpec firstDay(std::uint64_t first_seed, int pair, Hidden hidden) {
  const std::uint64_t seed = seedOf(first_seed, pair);
  const std::filesystem::path urdf =
      std::filesystem::path(STIFFSCOPE_TEST_OUTPUT) / "simulated-pairs" / fmt::format("{}.urdf", seed);
  simulation::SimulationSpec spec = validation::drawMachine(seed, "before", urdf).spec;
  numerics::RandomStream random(seed, "hidden");
  if (hidden != Hidden::nothing) hideBearingsAndLinks(random, spec);
  if (hidden == Hidden::bearings_links_and_base) {
    const double rate = *spec.machine.joints[1].torsion * random.uniform(3.0, 8.0);
    spec.machine.base_rotation = rate * Eigen::Vector3d(1.0, random.uniform(0.6, 1.6), 10.0);
  }
  return spec;
}

simulation::SimulationSpec anotherDay(const simulation::SimulationSpec& first, const std::array<double, 6>& factors,
                                      std::uint64_t measurement) {
  simulation::SimulationSpec spec = first;
  spec.name = "after";
  spec.measurement = measurement;
  for (std::size_t j = 0; j < 6; ++j) *spec.machine.joints[j].torsion /= factors[j];
  numerics::RandomStream random(first.seed, fmt::format("day {}", measurement));
  Eigen::Isometry3d& tracker = spec.tracker.base_from_tracker;
  tracker.translation() += 0.3 * random.normal3();
  tracker.linear() = Eigen::AngleAxisd(3.0 * kDegree * random.normal(), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                     tracker.linear();
  for (simulation::ListedPosture& posture : spec.postures) {
    for (int j = 0; j < 6; ++j) {
      posture.q[j] += 0.002 * kDegree * std::clamp(random.normal(), -3.0, 3.0);
    }
  }
  return spec;
}

std::array<double, 6> drawnChange(std::uint64_t first_seed, int pair) {
  numerics::RandomStream random(seedOf(first_seed, pair), "change");
  std::array<double, 6> factors{1, 1, 1, 1, 1, 1};
  if (pair % 2 == 0) {
    for (const std::size_t joint : {0u, 1u, 2u}) factors[joint] = random.uniform(0.4, 0.8);
  } else {
    factors[std::min<std::size_t>(5, static_cast<std::size_t>(6.0 * random.uniform()))] = random.uniform(1.05, 1.5);
  }
  return factors;
}

}  // namespace stiffscope::simulated_pairs
