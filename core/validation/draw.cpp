
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/io/units.h"
#include "core/io/write_file.h"
#include "core/numerics/random.h"
#include "core/robot/read_urdf.h"
#include "core/simulation/postures.h"
#include "core/validation/day_parts.h"
#include "core/validation/effect_draw.h"

namespace stiffscope::validation {

const std::array<ArmModel, 4> kArmModels{{
    // FANUC M-900iB/700, 700 kg, 2.83 m
    {"m900ib700",
     "heavy",
     0.94,
     0.41,
     1.12,
     0.25,
     1.285,
     0.30,
     {1, 1, 1, 1, 1, 1},
     {1000, 550, 650, 160, 60, 15},
     {7e6, 4.5e6, 4.5e6, 4.6e5, 3.5e5, 1.2e5},
     {1200, 2400},
     45},
    // KUKA KR 210 R2700 extra, 210 kg, 2.70 m
    {"kr210r2700",
     "large",
     0.675,
     0.35,
     1.15,
     -0.041,
     1.20,
     0.215,
     {-1, 1, -1, 1, -1, 1},
     {330, 260, 220, 90, 40, 10},
     {3.0e6, 2.8e6, 2.0e6, 3.5e5, 2.5e5, 0.9e5},
     {900, 1700},
     25},
    // ABB IRB 4600-60/2.05, 60 kg, 2.05 m
    {"irb4600_60",
     "medium",
     0.495,
     0.175,
     0.90,
     0.175,
     0.96,
     0.135,
     {1, 1, -1, -1, -1, -1},
     {140, 90, 85, 35, 12, 3},
     {1.2e6, 1.0e6, 7e5, 8e4, 6e4, 3e4},
     {300, 550},
     10},
    // FANUC M-20iA, 20 kg, 1.81 m
    {"m20ia",
     "small",
     0.525,
     0.15,
     0.79,
     0.25,
     0.835,
     0.10,
     {1, 1, 1, 1, 1, 1},
     {85, 45, 45, 18, 7, 1.5},
     {3.0e5, 2.5e5, 2.0e5, 2.5e4, 1.8e4, 0.9e4},
     {110, 190},
     4},
}};

namespace {

struct Part {
  double x, z;                   ///< of the joint in the link before it
  const char* axis[2];           ///< of positive and negative sense
  double com_x, com_z;           ///< of the body in its own link
  std::array<double, 2> limits;  ///< rad, for positive sense
};

std::string linkXml(int index, double mass, const Part& part) {
  return fmt::format(
      "  <link name=\"link_{}\"><inertial><origin xyz=\"{:.6g} 0 {:.6g}\"/><mass value=\"{:.6g}\"/>"
      "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n",
      index, part.com_x, part.com_z, mass);
}

std::string jointXml(int index, int sense, const Part& part) {
  std::array<double, 2> limits = part.limits;
  if (sense < 0) limits = {-part.limits[1], -part.limits[0]};
  return fmt::format(
      "  <joint name=\"joint_{0}\" type=\"revolute\">\n    <parent link=\"{1}\"/><child link=\"link_{0}\"/>\n"
      "    <origin xyz=\"{2:.6g} 0 {3:.6g}\" rpy=\"0 0 0\"/><axis xyz=\"{4}\"/>\n"
      "    <limit lower=\"{5}\" upper=\"{6}\" effort=\"0\" velocity=\"0\"/>\n  </joint>\n",
      index, index == 1 ? "base_link" : fmt::format("link_{}", index - 1), part.x, part.z, part.axis[sense > 0 ? 0 : 1],
      limits[0], limits[1]);
}

}  // namespace

std::string armUrdf(const ArmModel& m) {
  constexpr const char *kX = "1 0 0", *kMinusX = "-1 0 0", *kY = "0 1 0", *kMinusY = "0 -1 0";
  const std::array<Part, 6> parts{{{0, m.d1, {"0 0 1", "0 0 -1"}, 0.37 * m.a1, -0.2 * m.d1, {-3.1, 3.1}},
                                   {m.a1, 0, {kY, kMinusY}, 0, 0.45 * m.a2, {-1.1, 1.5}},
                                   {0, m.a2, {kMinusY, kY}, -0.08 * m.d4, 0.6 * m.a3, {-2.2, 0.9}},
                                   {0, m.a3, {kMinusX, kX}, 0.55 * m.d4, 0, {-3.1, 3.1}},
                                   {m.d4, 0, {kMinusY, kY}, 0.17 * m.d6, 0, {-2.1, 2.1}},
                                   {m.d6, 0, {kMinusX, kX}, 0, 0, {-3.1, 3.1}}}};
  std::string text =
      fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base_link\"/>\n", m.name);
  for (std::size_t i = 0; i < 6; ++i) text += linkXml(static_cast<int>(i) + 1, m.masses_kg[i], parts[i]);
  text += "  <link name=\"tool0\"/>\n";
  for (std::size_t i = 0; i < 6; ++i) text += jointXml(static_cast<int>(i) + 1, m.sense[i], parts[i]);
  return text +
         "  <joint name=\"flange\" type=\"fixed\"><parent link=\"link_6\"/><child link=\"tool0\"/>"
         "<origin xyz=\"0 0 0\" rpy=\"3.141592653589793 -1.5707963267948966 0\"/></joint>\n</robot>\n";
}

namespace {

using Eigen::Vector3d;
using numerics::RandomStream;

int pick(numerics::RandomStream& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform() * count));
}

ArmModel drawArm(numerics::RandomStream& random) {
  ArmModel model = kArmModels[static_cast<std::size_t>(pick(random, static_cast<int>(kArmModels.size())))];
  for (double* length : {&model.d1, &model.a1, &model.a2, &model.a3, &model.d4, &model.d6}) {
    *length *= random.uniform(0.9, 1.1);
  }
  for (double& stiffness : model.stiffness) stiffness *= std::exp(0.25 * random.normal());
  return model;
}

DayScale scaleOf(const ArmModel& m) { return {m.a1 + m.a2 + m.d4 + m.d6, m.tool_kg, m.load_n}; }

}  // namespace

void addSprings(const std::vector<double>& stiffness, const DayScale& day, RandomStream& random,
                simulation::SimulationSpec& spec) {
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    spec.machine.joints[i].torsion = stiffness[i];
    spec.machine.joints[i].bearing = 1200.0 * stiffness[i] * std::exp(0.3 * random.normal());
  }
  spec.machine.geometry.position_sigma = 1e-4;
  spec.machine.geometry.direction_sigma = 0.006 * io::kDegree;
  spec.machine.geometry.zero_sigma = 0.006 * io::kDegree;
  spec.machine.geometry.wrist_position_sigma = 3e-5;
  spec.machine.tool = {day.tool_kg, Vector3d(0, 0, 0.1)};
}

void addInstruments(const DayScale& day, RandomStream& random, simulation::SimulationSpec& spec) {
  const double size = 0.07 + 0.06 * day.reach;
  for (int t = 0; t < 3; ++t) {
    const double angle = 2.0 * std::numbers::pi * t / 3 + random.uniform(-0.3, 0.3);
    const double radius = size * random.uniform(0.9, 1.2);
    spec.targets.push_back(
        {"P1" + std::to_string(t), {radius * std::cos(angle), radius * std::sin(angle), random.uniform(0.03, 0.09)}});
  }
  simulation::TrackerSpec& tracker = spec.tracker;
  const double quality = random.uniform(0.8, 1.3);
  tracker.declared = {"absolute tracker", 4e-6 * quality,   0.6e-6 * quality,
                      6e-6 * quality,     2.2e-6 * quality, Vector3d::Zero()};
  const double bearing = random.uniform(-0.6, 0.6);
  const double distance = 1.3 * day.reach + random.uniform(0.8, 1.6);
  tracker.base_from_tracker.linear() = (Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(0.3 * io::kDegree * random.normal(), Vector3d::UnitX()) *
                                        Eigen::AngleAxisd(0.3 * io::kDegree * random.normal(), Vector3d::UnitY()))
                                           .toRotationMatrix();
  tracker.base_from_tracker.translation() << distance * std::cos(bearing), distance * std::sin(bearing),
      random.uniform(0.9, 1.4);
  const double round = day.reach + 0.5;
  for (int n = 0; n < 4; ++n) {
    const double angle = 0.7 + 1.4 * n + random.uniform(-0.3, 0.3);
    spec.nests.push_back(
        {"N" + std::to_string(n + 1), {round * std::cos(angle), round * std::sin(angle), random.uniform(0.02, 0.5)}});
  }
  spec.nests_after_sweeps = true;
  spec.timing.nest_interval_s = 2400.0;
}

namespace {

/// Down, and five level or rising to the sides: a cable over pulleys at the walls.
Vector3d pullDirection(int posture) {
  if (posture % 6 == 0) return -Vector3d::UnitZ();
  const double angle = 2.0 * std::numbers::pi * (posture % 6) / 5 + 0.2;
  return Vector3d(std::cos(angle), std::sin(angle), posture % 2 == 0 ? 0.35 : -0.4).normalized();
}

}  // namespace

void pullAllRound(simulation::SimulationSpec& spec) {
  for (std::size_t p = 0; p < spec.postures.size(); ++p) {
    spec.postures[p].pull_direction = pullDirection(static_cast<int>(p));
  }
}

std::string addLoad(const DayScale& day, RandomStream& random, simulation::SimulationSpec& spec) {
  spec.loading.emplace();
  const double full = random.uniform(day.load_n[0], day.load_n[1]);
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
  const double size = 0.02 + 0.04 * day.reach;
  spec.loading->hook_in_flange = Vector3d(random.uniform(-size, size), random.uniform(-size, size), 0.16 + size);
  spec.load_cell.emplace();
  campaign::LoadCell& cell = spec.load_cell->declared;
  cell.parent = "tool0";
  cell.parent_from_cell.translation() = Vector3d(0, 0, 0.09);
  cell.parent_from_cell.linear() = Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Vector3d::UnitZ()).toRotationMatrix();
  cell.force_sigma = 6e-4 * full;
  cell.moment_sigma = 2e-4 * full;
  return hanging ? "hanging" : "cable";
}

void listPostures(simulation::SimulationSpec& spec) {
  const std::vector<simulation::Posture> postures = simulation::loadingPostures(spec);
  spec.posture_draw.reset();
  for (const simulation::Posture& posture : postures) spec.postures.push_back({posture.q, {}});
}

namespace {

/// A box of joint angles, deg, stated for positive senses.
simulation::PostureDraw postureBox(const ArmModel& model, const std::array<double, 6>& low,
                                   const std::array<double, 6>& high) {
  simulation::PostureDraw draw(6);
  for (int i = 0; i < 6; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const bool same = model.sense[k] > 0;
    draw.low[i] = io::kDegree * (same ? low[k] : -high[k]);
    draw.high[i] = io::kDegree * (same ? high[k] : -low[k]);
  }
  return draw;
}

/// Postures as a person would choose them: spread out, clear of the wrist's singularity, the flange level or
/// down, in the tracker's reach, for a hanging load the chain clear of the arm.
void addPostures(const ArmModel& model, bool hanging, simulation::SimulationSpec& spec) {
  simulation::PostureDraw draw = postureBox(model, {-50, -40, -60, -120, -100, -150}, {50, 55, 35, 120, 100, 150});
  draw.count = kLoadedPostures;
  draw.candidates = 8;
  draw.min_abs_sin_bend = 0.4;
  draw.max_flange_up = 25.0 * io::kDegree;
  draw.min_height = 0.25 * scaleOf(model).reach;
  if (hanging) draw.min_hang_clearance = 0.06 * scaleOf(model).reach;
  spec.posture_draw = draw;
  listPostures(spec);
  if (!hanging) pullAllRound(spec);
}

void addSweeps(const ArmModel& model, simulation::SimulationSpec& spec) {
  const std::array<double, 6> low{-55, -40, -60, -110, -95, -150}, high{55, 45, 30, 110, 95, 150};
  for (int i = 0; i < 6; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const double sense = model.sense[k];
    spec.circle_sweeps.push_back(
        {i, sense * low[k] * io::kDegree, sense * high[k] * io::kDegree, 24, JointVector::Zero(6)});
  }
  spec.wrist_sweep.emplace();
  spec.wrist_sweep->readings = 360;
  spec.wrist_sweep->scheme = simulation::WristScheme::all_targets;
  spec.wrist_sweep->low = -io::kDegree * Vector3d(150, 100, 160);
  spec.wrist_sweep->high = io::kDegree * Vector3d(150, 100, 160);
  spec.timing = {2.0, 4.0, 60.0, spec.timing.nest_interval_s};
}

}  // namespace

MachineDraw beginDay(const std::string& urdf_text, const std::string& arm_name, std::uint64_t seed,
                     const std::string& name, const std::filesystem::path& urdf_file) {
  io::makeFolder(urdf_file.parent_path());
  io::writeFileWhole(urdf_file, urdf_text);
  MachineDraw draw;
  draw.arm = arm_name;
  simulation::SimulationSpec& spec = draw.spec;
  spec.name = name;
  spec.date = "2026-01-01";
  spec.seed = seed;
  spec.urdf_file = urdf_file;
  spec.base_link = "base_link";
  spec.flange_link = "tool0";
  spec.nominal = robot::readUrdf(urdf_file, spec.base_link, spec.flange_link);
  spec.machine.joints.resize(static_cast<std::size_t>(spec.nominal.joints()));
  spec.read_back_resolution = 1e-5 * io::kDegree;
  return draw;
}

MachineDraw drawMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file) {
  numerics::RandomStream random(seed, "machine");
  const ArmModel model = drawArm(random);
  MachineDraw draw = beginDay(armUrdf(model), std::string(model.name), seed, name, urdf_file);
  const DayScale day = scaleOf(model);
  addSprings({model.stiffness.begin(), model.stiffness.end()}, day, random, draw.spec);
  addInstruments(day, random, draw.spec);
  draw.loading = addLoad(day, random, draw.spec);
  addPostures(model, draw.loading == "hanging", draw.spec);
  addSweeps(model, draw.spec);
  return draw;
}

MachineDraw drawUnloadedMachine(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file) {
  numerics::RandomStream random(seed, "machine");
  const ArmModel model = drawArm(random);
  MachineDraw draw = beginDay(armUrdf(model), std::string(model.name), seed, name, urdf_file);
  draw.loading = "unloaded";
  simulation::SimulationSpec& spec = draw.spec;
  spec.machine.geometry.position_sigma = 2e-4 * random.uniform(0.6, 1.4);
  spec.machine.geometry.direction_sigma = spec.machine.geometry.zero_sigma =
      0.008 * io::kDegree * random.uniform(0.6, 1.4);
  spec.machine.mass_relative_sigma = 0.02;
  addInstruments(scaleOf(model), random, spec);
  if (random.uniform() < 1.0 / 7.0) spec.targets.resize(1);
  if (random.uniform() < 0.2) spec.nests.clear();
  spec.nests_after_sweeps = false;
  spec.unloaded_repeats = 2 + pick(random, 2);
  spec.timing = {2.0, random.uniform(6.0, 20.0), 0.0, random.uniform(400.0, 900.0)};

  simulation::PostureDraw postures =
      postureBox(model, {-130, -50, -70, -170, -110, -170}, {130, 70, 50, 170, 110, 170});
  postures.count = 60 + pick(random, 141);
  postures.min_height = 0.1 * scaleOf(model).reach;
  postures.min_tracker_distance = 0.6;
  spec.posture_draw = postures;
  listPostures(spec);

  const bool read = random.uniform() < 0.5;
  const double warmer = random.uniform(1.0, 6.0) * (random.uniform() < 0.75 ? 1.0 : -1.0);
  const double begin = random.uniform(17.0, 25.0), knee = random.uniform(0.3, 0.7) * dayLength(spec);
  const double after_knee = random.uniform(-0.5, 0.5) * warmer;
  if (read) spec.temperature = {{0.0, knee, dayLength(spec)}, {begin, begin + warmer, begin + warmer + after_knee}};
  return draw;
}

}  // namespace stiffscope::validation
