#include "core/blind/machine_draw.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/input/units.h"
#include "core/input/write_file.h"
#include "core/robot/read_urdf.h"
#include "core/simulation/postures.h"
#include "core/simulation/random.h"

namespace stiffscope::blind {

namespace {

using Eigen::Vector3d;
using simulation::RandomStream;

constexpr int kPostures = 24;

int pick(RandomStream& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform() * count));
}

ArmModel drawArm(RandomStream& random) {
  ArmModel model = kArmModels[static_cast<std::size_t>(pick(random, static_cast<int>(kArmModels.size())))];
  for (double* length : {&model.d1, &model.a1, &model.a2, &model.a3, &model.d4, &model.d6}) {
    *length *= random.uniform(0.9, 1.1);
  }
  for (double& stiffness : model.stiffness) stiffness *= std::exp(0.25 * random.normal());
  return model;
}

double reach(const ArmModel& m) { return m.a1 + m.a2 + m.d4 + m.d6; }

void addSprings(const ArmModel& model, RandomStream& random, SimulationSpec& spec) {
  for (std::size_t i = 0; i < 6; ++i) {
    spec.machine.joints[i].torsion = model.stiffness[i];
    spec.machine.joints[i].bearing = 1200.0 * model.stiffness[i] * std::exp(0.3 * random.normal());
  }
  spec.machine.geometry.position_sigma = 1e-4;
  spec.machine.geometry.direction_sigma = 0.006 * kDegree;
  spec.machine.geometry.zero_sigma = 0.006 * kDegree;
  spec.machine.geometry.wrist_position_sigma = 3e-5;
  spec.machine.tool = {model.tool_kg, Vector3d(0, 0, 0.1)};
}

void addInstruments(const ArmModel& model, RandomStream& random, SimulationSpec& spec) {
  const double size = 0.07 + 0.06 * reach(model);
  for (int t = 0; t < 3; ++t) {
    const double angle = 2.0 * std::numbers::pi * t / 3 + random.uniform(-0.3, 0.3);
    const double radius = size * random.uniform(0.9, 1.2);
    spec.targets.push_back(
        {"P1" + std::to_string(t),
         {radius * std::cos(angle), radius * std::sin(angle), random.uniform(0.03, 0.09)}});
  }
  simulation::TrackerSpec& tracker = spec.tracker;
  const double quality = random.uniform(0.8, 1.3);
  tracker.declared = {"absolute tracker", 4e-6 * quality,   0.6e-6 * quality,
                      6e-6 * quality,     2.2e-6 * quality, Vector3d::Zero()};
  const double bearing = random.uniform(-0.6, 0.6);
  const double distance = 1.3 * reach(model) + random.uniform(0.8, 1.6);
  tracker.base_from_tracker.linear() =
      (Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Vector3d::UnitZ()) *
       Eigen::AngleAxisd(0.3 * kDegree * random.normal(), Vector3d::UnitX()) *
       Eigen::AngleAxisd(0.3 * kDegree * random.normal(), Vector3d::UnitY()))
          .toRotationMatrix();
  tracker.base_from_tracker.translation() << distance * std::cos(bearing), distance * std::sin(bearing),
      random.uniform(0.9, 1.4);
  const double round = reach(model) + 0.5;
  for (int n = 0; n < 4; ++n) {
    const double angle = 0.7 + 1.4 * n + random.uniform(-0.3, 0.3);
    spec.nests.push_back({"N" + std::to_string(n + 1),
                          {round * std::cos(angle), round * std::sin(angle), random.uniform(0.02, 0.5)}});
  }
  spec.nests_after_sweeps = true;
  spec.timing.nest_interval_s = 2400.0;
}

/// Down, and five level or rising to the sides: a cable over pulleys at the walls.
Vector3d pullDirection(int posture) {
  if (posture % 6 == 0) return -Vector3d::UnitZ();
  const double angle = 2.0 * std::numbers::pi * (posture % 6) / 5 + 0.2;
  return Vector3d(std::cos(angle), std::sin(angle), posture % 2 == 0 ? 0.35 : -0.4).normalized();
}

std::string addLoad(const ArmModel& model, RandomStream& random, SimulationSpec& spec) {
  spec.loading.emplace();
  const double full = random.uniform(model.load_n[0], model.load_n[1]);
  const std::array<double, 3> shares{0.4, 0.7, 1.0};
  const bool hanging = random.uniform() < 0.6;
  if (hanging) {
    simulation::HangingWeights weights;
    for (const double share : shares) weights.masses_kg.push_back(share * full / 9.80665);
    spec.loading->load = weights;
  } else {
    simulation::CablePull cable;
    for (const double share : shares) cable.tensions.push_back(share * full);
    spec.loading->load = cable;
  }
  const double size = 0.02 + 0.04 * reach(model);
  spec.loading->hook_in_flange =
      Vector3d(random.uniform(-size, size), random.uniform(-size, size), 0.16 + size);
  spec.load_cell.emplace();
  LoadCell& cell = spec.load_cell->declared;
  cell.parent = "tool0";
  cell.parent_from_cell.translation() = Vector3d(0, 0, 0.09);
  cell.parent_from_cell.linear() =
      Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Vector3d::UnitZ()).toRotationMatrix();
  cell.force_sigma = 6e-4 * full;
  cell.moment_sigma = 2e-4 * full;
  return hanging ? "hanging" : "cable";
}

/// Postures as a person would choose them: spread out, clear of the wrist's singularity, the flange level or
/// down, in the tracker's reach, for a hanging load the chain clear of the arm.
void addPostures(const ArmModel& model, bool hanging, SimulationSpec& spec) {
  simulation::PostureDraw draw;
  draw.count = kPostures;
  draw.candidates = 8;
  const std::array<double, 6> low{-50, -40, -60, -120, -100, -150}, high{50, 55, 35, 120, 100, 150};
  for (int i = 0; i < 6; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const bool same = model.sense[k] > 0;
    draw.low[i] = kDegree * (same ? low[k] : -high[k]);
    draw.high[i] = kDegree * (same ? high[k] : -low[k]);
  }
  draw.min_abs_sin_q5 = 0.4;
  draw.max_flange_up = 25.0 * kDegree;
  draw.min_height = 0.25 * reach(model);
  if (hanging) draw.min_hang_clearance = 0.06 * reach(model);
  spec.posture_draw = draw;
  const std::vector<simulation::Posture> postures = simulation::loadingPostures(spec);
  spec.posture_draw.reset();
  for (std::size_t p = 0; p < postures.size(); ++p) {
    simulation::ListedPosture listed{postures[p].q, {}};
    if (!hanging) listed.pull_direction = pullDirection(static_cast<int>(p));
    spec.postures.push_back(listed);
  }
}

void addSweeps(const ArmModel& model, SimulationSpec& spec) {
  const std::array<double, 6> low{-55, -40, -60, -110, -95, -150}, high{55, 45, 30, 110, 95, 150};
  for (int i = 0; i < 6; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const double sense = model.sense[k];
    spec.circle_sweeps.push_back(
        {i, sense * low[k] * kDegree, sense * high[k] * kDegree, 24, Vector6d::Zero()});
  }
  spec.wrist_sweep.emplace();
  spec.wrist_sweep->readings = 360;
  spec.wrist_sweep->scheme = simulation::WristScheme::all_targets;
  spec.wrist_sweep->low = -kDegree * Vector3d(150, 100, 160);
  spec.wrist_sweep->high = kDegree * Vector3d(150, 100, 160);
  spec.timing = {2.0, 4.0, 60.0, spec.timing.nest_interval_s};
}

}  // namespace

MachineDraw drawMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file) {
  RandomStream random(seed, "machine");
  const ArmModel model = drawArm(random);
  makeFolder(urdf_file.parent_path());
  writeFileWhole(urdf_file, armUrdf(model));

  MachineDraw draw;
  draw.arm = std::string(model.name);
  SimulationSpec& spec = draw.spec;
  spec.name = name;
  spec.date = "2026-01-01";
  spec.seed = seed;
  spec.urdf_file = urdf_file;
  spec.base_link = "base_link";
  spec.flange_link = "tool0";
  spec.nominal = readUrdf(urdf_file, spec.base_link, spec.flange_link);
  spec.read_back_resolution = 1e-5 * kDegree;
  addSprings(model, random, spec);
  addInstruments(model, random, spec);
  draw.loading = addLoad(model, random, spec);
  addPostures(model, draw.loading == "hanging", spec);
  addSweeps(model, spec);
  return draw;
}

}  // namespace stiffscope::blind
