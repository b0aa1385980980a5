#include "core/validation/machine_kinds.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/io/units.h"
#include "core/numerics/random.h"
#include "core/validation/day_parts.h"

namespace stiffscope::validation {

namespace {

using Eigen::Vector3d;

/// A joint and the body beyond it, axes parallel to base_link's with all joints at zero. m, kg, Nm/rad, degrees.
struct KindJoint {
  Vector3d origin;  ///< from the joint before
  Vector3d axis;
  double mass;
  Vector3d com;  ///< of the body, from the joint
  double stiffness;
  double limit;                   ///< either side of zero
  std::array<double, 2> posture;  ///< of the loaded postures
  std::array<double, 2> sweep;
};

/// An axis at the origin of joint `before` that turns with another joint: rods. From 0.
struct KindFollower {
  std::size_t before, follows;
  Vector3d axis;
  double multiplier;
};

struct KindModel {
  std::vector<KindJoint> joints;
  Vector3d flange;          ///< from the last joint
  Vector3d flange_rpy_deg;  ///< z of the flange points away from the arm
  DayScale day;
  double max_flange_up_deg;
  double min_abs_sin_bend;  ///< of the wrist's bend, for machines with a wrist of three axes
  std::optional<KindFollower> follower = std::nullopt;
  double rail = 0.0;  ///< length of a linear axis along base_link's x, m; 0: it stands on none
};

const Vector3d kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// Universal Robots UR10: the maker's DH parameters and masses; stiffnesses of the size that published tests of that
/// class of arm give.
KindModel offsetWrist() {
  return {{{{0, 0, 0.1273}, kZ, 7.78, {0, 0.05, 0}, 3.5e4, 180, {-90, 90}, {-110, 110}},
           {{0, 0.1759, 0}, kY, 12.93, {0.306, 0, 0}, 3.0e4, 180, {-80, -15}, {-100, 20}},
           {{0.612, -0.1282, 0}, kY, 3.87, {0.286, 0, 0}, 2.5e4, 160, {20, 120}, {-60, 120}},
           {{0.5723, 0, 0}, kY, 1.96, {0, 0.08, 0}, 7.0e3, 180, {-110, 110}, {-120, 120}},
           {{0, 0.1149, 0}, -kZ, 1.96, {0, 0, -0.07}, 6.1e3, 180, {-130, 130}, {-120, 120}},
           {{0, 0, -0.1157}, kY, 0.20, {0, 0.06, 0}, 6.1e3, 180, {-150, 150}, {-150, 150}}},
          {0, 0.0922, 0},
          {-90, 0, 0},
          {1.3, 1.5, {50, 95}},
          60,
          0.0};
}

/// KUKA LBR iiwa 14 R820: the maker's lengths; masses and stiffnesses of the size that published models have.
KindModel sevenAxis() {
  return {{{{0, 0, 0.36}, kZ, 4.0, {0, 0.03, -0.1}, 2.4e4, 170, {-90, 90}, {-120, 120}},
           {{0, 0, 0}, kY, 4.0, {0, 0.04, 0.10}, 2.4e4, 120, {20, 80}, {-70, 90}},
           {{0, 0, 0.42}, kZ, 3.0, {0, -0.03, -0.12}, 1.6e4, 170, {-80, 80}, {-120, 120}},
           {{0, 0, 0}, -kY, 2.7, {0, 0.03, 0.09}, 1.6e4, 120, {-100, -25}, {-100, 60}},
           {{0, 0, 0.40}, kZ, 1.7, {0, -0.02, -0.14}, 1.0e4, 170, {-120, 120}, {-120, 120}},
           {{0, 0, 0}, kY, 1.8, {0, 0, 0.02}, 8.0e3, 120, {-95, 95}, {-95, 95}},
           {{0, 0, 0.08}, kZ, 0.3, {0, 0, 0.03}, 6.0e3, 175, {-150, 150}, {-150, 150}}},
          {0, 0, 0.046},
          {0, 0, 0},
          {0.95, 1.2, {70, 135}},
          40,
          0.4};
}

/// A five-axis palletiser of the size of a KUKA KR 180 PA: 180 kg, 3.2 m.
KindModel palletiser() {
  return {{{{0, 0, 0.75}, kZ, 700, {0.1, 0, -0.2}, 4.0e6, 185, {-60, 60}, {-80, 80}},
           {{0.35, 0, 0}, kY, 260, {0, 0, 0.55}, 3.4e6, 130, {-35, 50}, {-35, 50}},
           {{0, 0, 1.35}, kY, 230, {0.55, 0, 0.05}, 2.6e6, 150, {-35, 45}, {-35, 45}},
           {{1.45, 0, 0}, kY, 60, {0.05, 0, -0.05}, 4.5e5, 120, {-50, 50}, {-60, 60}},
           {{0, 0, -0.12}, -kZ, 15, {0, 0, -0.05}, 2.2e5, 350, {-150, 150}, {-150, 150}}},
          {0, 0, -0.13},
          {180, 0, 0},
          {3.2, 15.0, {800, 1600}},
          -30,
          0.0};
}

/// A heavy six-axis arm of 2.7 m whose motors 2 and 3 both sit at the shoulder: joint 3 turns the forearm against the
/// base, through rods along the upper arm. Dimensions and springs of the size of the paper's machine (Table II).
KindModel parallelogram() {
  return {{{{0, 0, 0.94}, kZ, 750, {0.12, 0, -0.15}, 7.0e6, 180, {-70, 70}, {-60, 60}},
           {{0.41, 0, 0}, kY, 500, {0, 0, 0.48}, 5.6e6, 75, {-35, 50}, {-50, 50}},
           {{0, 0, 1.12}, kY, 550, {-0.05, 0, 0.16}, 6.3e6, 100, {-25, 45}, {-40, 60}},
           {{0, 0, 0.25}, -kX, 180, {0.75, 0, 0}, 4.6e5, 350, {-110, 110}, {-120, 120}},
           {{1.285, 0, 0}, -kY, 90, {0.06, 0, 0}, 3.5e5, 120, {-100, 100}, {-110, 110}},
           {{0.3, 0, 0}, -kX, 30, {-0.03, 0, 0}, 7.9e4, 350, {-150, 150}, {-150, 150}}},
          {0, 0, 0},
          {180, -90, 0},
          {2.7, 15.0, {700, 1500}},
          20,
          0.5,
          KindFollower{2, 1, kY, -1.0}};
}

/// KUKA KR 210 R2700 on a linear axis: the maker's lengths; masses and springs of that class of arm.
KindModel onRail() {
  return {{{{0, 0, 0.675}, kZ, 400, {0.10, 0, -0.10}, 4.0e6, 185, {-70, 70}, {-60, 60}},
           {{0.35, 0, 0}, kY, 230, {0, 0, 0.50}, 3.4e6, 140, {-40, 50}, {-45, 50}},
           {{0, 0, 1.15}, kY, 210, {0.05, 0, 0.02}, 2.6e6, 155, {-40, 55}, {-45, 60}},
           {{0, 0, -0.041}, kX, 80, {0.65, 0, 0}, 4.2e5, 350, {-110, 110}, {-120, 120}},
           {{1.2, 0, 0}, kY, 45, {0.06, 0, 0}, 3.2e5, 125, {-100, 100}, {-110, 110}},
           {{0.215, 0, 0}, kX, 15, {-0.02, 0, 0}, 1.1e5, 350, {-150, 150}, {-150, 150}}},
          {0, 0, 0},
          {180, -90, 0},
          {2.7, 12.0, {600, 1300}},
          20,
          0.5,
          std::nullopt,
          6.0};
}

KindModel modelOf(MachineKind kind) {
  if (kind == MachineKind::rail) return onRail();
  if (kind == MachineKind::parallelogram) return parallelogram();
  if (kind == MachineKind::offset_wrist) return offsetWrist();
  if (kind == MachineKind::seven_axis) return sevenAxis();
  return palletiser();
}

std::string written(const Vector3d& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z()); }

std::string urdfOf(const KindModel& model, std::string_view name, double scale) {
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base_link\"/>\n", name);
  const std::string foot = model.rail > 0.0 ? "carriage" : "base_link";
  if (model.rail > 0.0) {
    text += fmt::format(
        "  <link name=\"carriage\"/>\n"
        "  <joint name=\"rail\" type=\"prismatic\">\n    <parent link=\"base_link\"/><child link=\"carriage\"/>\n"
        "    <axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"{:.9g}\" effort=\"0\" velocity=\"0\"/>\n  </joint>\n",
        model.rail);
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const KindJoint& joint = model.joints[i];
    const double limit = joint.limit * io::kDegree;
    std::string parent = i == 0 ? foot : fmt::format("link_{}", i);
    Vector3d origin = scale * joint.origin;
    if (model.follower && model.follower->before == i) {
      text += fmt::format(
          "  <link name=\"rods\"/>\n"
          "  <joint name=\"rods\" type=\"continuous\">\n    <parent link=\"{}\"/><child link=\"rods\"/>\n"
          "    <origin xyz=\"{}\" rpy=\"0 0 0\"/><axis xyz=\"{}\"/>"
          "<mimic joint=\"joint_{}\" multiplier=\"{:g}\"/>\n  </joint>\n",
          parent, written(origin), written(model.follower->axis), model.follower->follows + 1,
          model.follower->multiplier);
      parent = "rods";
      origin.setZero();
    }
    text += fmt::format(
        "  <link name=\"link_{0}\"><inertial><origin xyz=\"{1}\"/><mass value=\"{2:.9g}\"/>"
        "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n"
        "  <joint name=\"joint_{0}\" type=\"revolute\">\n    <parent link=\"{3}\"/><child link=\"link_{0}\"/>\n"
        "    <origin xyz=\"{4}\" rpy=\"0 0 0\"/><axis xyz=\"{5}\"/>\n"
        "    <limit lower=\"{6:.9g}\" upper=\"{7:.9g}\" effort=\"0\" velocity=\"0\"/>\n  </joint>\n",
        i + 1, written(scale * joint.com), joint.mass, parent, written(origin), written(joint.axis), -limit, limit);
  }
  return text + fmt::format(
                    "  <link name=\"tool0\"/>\n  <joint name=\"flange\" type=\"fixed\"><parent link=\"link_{}\"/>"
                    "<child link=\"tool0\"/><origin xyz=\"{}\" rpy=\"{}\"/></joint>\n</robot>\n",
                    model.joints.size(), written(scale * model.flange), written(io::kDegree * model.flange_rpy_deg));
}

/// Postures as a person would choose them, of the kind's own ranges.
void addPostures(const KindModel& model, bool hanging, simulation::SimulationSpec& spec) {
  const auto joints = static_cast<Eigen::Index>(model.joints.size());
  simulation::PostureDraw draw(static_cast<int>(joints));
  for (Eigen::Index j = 0; j < joints; ++j) {
    const KindJoint& joint = model.joints[static_cast<std::size_t>(j)];
    draw.low[j] = joint.posture[0] * io::kDegree;
    draw.high[j] = joint.posture[1] * io::kDegree;
  }
  draw.count = kLoadedPostures;
  draw.candidates = 8;
  draw.min_abs_sin_bend = model.min_abs_sin_bend;
  draw.max_flange_up = model.max_flange_up_deg * io::kDegree;
  draw.min_height = 0.2 * model.day.reach;
  if (hanging) draw.min_hang_clearance = 0.05 * model.day.reach;
  spec.posture_draw = draw;
  listPostures(spec);
  if (!hanging) pullAllRound(spec);
}

void addSweeps(const KindModel& model, simulation::SimulationSpec& spec) {
  const auto joints = static_cast<Eigen::Index>(model.joints.size());
  for (Eigen::Index j = 0; j < joints; ++j) {
    const KindJoint& joint = model.joints[static_cast<std::size_t>(j)];
    spec.circle_sweeps.push_back({static_cast<int>(j), joint.sweep[0] * io::kDegree, joint.sweep[1] * io::kDegree, 24,
                                  JointVector::Zero(joints)});
  }
  const int wrist = robot::wristJointsOf(static_cast<int>(joints));
  spec.wrist_sweep.emplace();
  spec.wrist_sweep->readings = 360;
  spec.wrist_sweep->scheme = simulation::WristScheme::all_targets;
  spec.wrist_sweep->arm = JointVector::Zero(joints - wrist);
  spec.wrist_sweep->low.resize(wrist);
  spec.wrist_sweep->high.resize(wrist);
  for (int k = 0; k < wrist; ++k) {
    const KindJoint& joint = model.joints[static_cast<std::size_t>(joints - wrist + k)];
    spec.wrist_sweep->low[k] = joint.sweep[0] * io::kDegree;
    spec.wrist_sweep->high[k] = joint.sweep[1] * io::kDegree;
  }
  spec.timing = {2.0, 4.0, 60.0, spec.timing.nest_interval_s};
}

/// The middle half of the rail, so that the tracker beside the arm sees it; as straight and as true as rails are.
void addRail(double length, numerics::RandomStream& random, simulation::SimulationSpec& spec) {
  if (length == 0.0) return;
  simulation::RailSpec& rail = spec.rail;
  rail.low = 0.25 * length;
  rail.high = 0.75 * length;
  rail.sweeps_at = 0.5 * length;
  rail.stops = 15;
  rail.tilt = 0.1 * io::kDegree * random.normal3();
  rail.scale = 1.0 + 1e-4 * random.normal();
  rail.straightness = random.uniform(0.0, 40e-6);
  rail.stop_sigma = 20e-6;
  // The tracker stands where it would beside an arm at the middle.
  spec.tracker.base_from_tracker.translation() += rail.sweeps_at * spec.nominal.rail->direction_in_base;
  for (simulation::NestSpec& nest : spec.nests)
    nest.position_in_base += rail.sweeps_at * spec.nominal.rail->direction_in_base;
}

}  // namespace

std::optional<MachineKind> machineKindOf(std::string_view name) {
  const auto found = std::find(kMachineKindNames.begin(), kMachineKindNames.end(), name);
  if (found == kMachineKindNames.end()) return std::nullopt;
  return static_cast<MachineKind>(found - kMachineKindNames.begin());
}

std::string kindUrdf(MachineKind kind, double scale) { return urdfOf(modelOf(kind), nameOf(kind), scale); }

MachineDraw drawMachineOfKind(MachineKind kind, std::uint64_t seed, const std::string& name,
                              const std::filesystem::path& urdf_file) {
  if (kind == MachineKind::six_axis) return drawMachine(seed, name, urdf_file);
  numerics::RandomStream random(seed, "machine");
  KindModel model = modelOf(kind);
  const double scale = random.uniform(0.9, 1.1);
  model.day.reach *= scale;
  std::vector<double> stiffness;
  for (const KindJoint& joint : model.joints) stiffness.push_back(joint.stiffness * std::exp(0.25 * random.normal()));
  MachineDraw draw = beginDay(urdfOf(model, nameOf(kind), scale), std::string(nameOf(kind)), seed, name, urdf_file);
  addSprings(stiffness, model.day, random, draw.spec);
  addInstruments(model.day, random, draw.spec);
  draw.loading = addLoad(model.day, random, draw.spec);
  addRail(model.rail, random, draw.spec);
  addPostures(model, draw.loading == "hanging", draw.spec);
  addSweeps(model, draw.spec);
  return draw;
}

}  // namespace stiffscope::validation
