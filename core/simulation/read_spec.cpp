#include "core/simulation/read_spec.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/campaign/campaign_xml.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/robot/read_urdf.h"
#include "core/simulation/rail_beam.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

std::vector<TrueTarget> readTargets(const io::XmlNode& root) {
  const io::XmlNode list = root.requiredChild("targets");
  refuseUnknown(list, {}, {"target"});
  std::vector<TrueTarget> targets;
  for (const io::XmlNode& node : list.children("target")) {
    refuseUnknown(node, {"id", "xyz_mm"}, {"motion"});
    const std::string id = node.requiredName("id");
    for (const TrueTarget& other : targets) {
      if (other.id == id) node.refuse("id", id, "expected every target once");
    }
    targets.push_back({id, node.vector("xyz_mm") * io::kMillimetre});
    if (const auto motion = node.child("motion")) targets.back().motion = readTargetMotion(*motion);
  }
  if (targets.empty()) list.refuse("target", "", "expected at least one target");
  return targets;
}

void readLaterStations(const io::XmlNode& tracker, TrackerSpec& spec) {
  const auto nodes = tracker.children("later_station");
  if (nodes.empty()) {
    if (tracker.has("station"))
      tracker.refuse("station", tracker.requiredAttribute("station"), "expected a later_station beside it");
    return;
  }
  spec.station = tracker.requiredName("station");
  int before = 1;
  for (const io::XmlNode& node : nodes) {
    refuseUnknown(node, {"station", "before_posture", "xyz_mm", "rpy_deg"});
    LaterStation& later = spec.later.emplace_back();
    later.id = node.requiredName("station");
    const bool again = later.id == spec.station || std::any_of(spec.later.begin(), spec.later.end() - 1,
                                                               [&](const auto& one) { return one.id == later.id; });
    if (again) node.refuse("station", later.id, "expected every station once");
    constexpr int kMost = 1000000;
    later.before_posture = integer(node, "before_posture", 1, kMost);
    if (later.before_posture <= before)
      node.refuse("before_posture", node.requiredAttribute("before_posture"),
                  "expected a posture after the first, and after that of the station before");
    before = later.before_posture;
    node.requiredAttribute("xyz_mm");
    node.requiredAttribute("rpy_deg");
    later.base_from_tracker = placement(node, "xyz_mm", "rpy_deg");
  }
}

TrackerSpec readTracker(const io::XmlNode& root) {
  const io::XmlNode node = root.requiredChild("tracker");
  refuseUnknown(node,
                {"model", "range_fixed_um", "range_per_m_um", "angle_fixed_um", "angle_per_m_um", "true_noise_factor",
                 "xyz_mm", "rpy_deg", "station"},
                {"later_station"});
  TrackerSpec tracker;
  tracker.declared.model = node.requiredName("model");
  tracker.declared.range_fixed = nonNegativeOr(node, "range_fixed_um", io::kMicrometre, 0.0);
  tracker.declared.range_per_m = nonNegativeOr(node, "range_per_m_um", io::kMicrometre, 0.0);
  tracker.declared.angle_fixed = nonNegativeOr(node, "angle_fixed_um", io::kMicrometre, 0.0);
  tracker.declared.angle_per_m = nonNegativeOr(node, "angle_per_m_um", io::kMicrometre, 0.0);
  tracker.true_noise_factor = nonNegativeOr(node, "true_noise_factor", 1.0, 1.0);
  if (tracker.true_noise_factor > 1000.0) {
    node.refuse("true_noise_factor", node.requiredAttribute("true_noise_factor"), "expected 0 to 1000");
  }
  node.requiredAttribute("xyz_mm");
  node.requiredAttribute("rpy_deg");
  tracker.base_from_tracker = placement(node, "xyz_mm", "rpy_deg");
  readLaterStations(node, tracker);
  return tracker;
}

std::optional<LoadCellSpec> readLoadCell(const io::XmlNode& root, const robot::Robot& robot) {
  const std::optional<io::XmlNode> node = root.child("load_cell");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"parent", "xyz_mm", "rpy_deg", "force_sigma_n", "moment_sigma_nm", "true_misalignment_deg",
                        "true_bias_n", "true_bias_nm", "true_gain_error", "true_place_error_mm", "unread_force_n"});
  LoadCellSpec cell;
  cell.declared.parent = node->requiredName("parent");
  std::vector<std::string> links;
  for (const robot::LinkFrame& link : robot.links) links.push_back(link.name);
  if (std::find(links.begin(), links.end(), cell.declared.parent) == links.end()) {
    node->refuse("parent", cell.declared.parent,
                 "expected a link of the robot's chain" + io::nearestNameHint(cell.declared.parent, links));
  }
  cell.declared.parent_from_cell = placement(*node, "xyz_mm", "rpy_deg");
  node->requiredAttribute("force_sigma_n");
  node->requiredAttribute("moment_sigma_nm");
  cell.declared.force_sigma = nonNegativeOr(*node, "force_sigma_n", 1.0, 0.0);
  cell.declared.moment_sigma = nonNegativeOr(*node, "moment_sigma_nm", 1.0, 0.0);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  cell.misalignment = vectorOr(*node, "true_misalignment_deg", io::kDegree, zero);
  cell.bias << vectorOr(*node, "true_bias_n", 1.0, zero), vectorOr(*node, "true_bias_nm", 1.0, zero);
  cell.gain_error = numberOr(*node, "true_gain_error", 1.0, 0.0);
  cell.place_error = vectorOr(*node, "true_place_error_mm", io::kMillimetre, zero);
  cell.unread_force = vectorOr(*node, "unread_force_n", 1.0, zero);
  return cell;
}

namespace {

constexpr int kMost = 1000000;  ///< of anything that is counted

std::vector<double> steps(const io::XmlNode& node, const std::string& attribute) {
  const std::vector<double> values = numberList(node, attribute, 0, 1.0);
  for (const double value : values) {
    if (!(value > 0.0)) {
      node.refuse(attribute, node.requiredAttribute(attribute),
                  "expected numbers above 0, one a step (the unloaded step 0 and the return are not listed)");
    }
  }
  return values;
}

CablePull readCable(const io::XmlNode& node) {
  CablePull cable{steps(node, "tensions_n"), std::nullopt, optionalDirection(node, "direction")};
  if (node.has("anchor_mm")) cable.anchor = node.vector("anchor_mm") * io::kMillimetre;
  if (cable.anchor && cable.direction) {
    node.refuse("direction", node.requiredAttribute("direction"), "expected anchor_mm or direction, not both");
  }
  return cable;
}

void readListed(const io::XmlNode& node, SimulationSpec& spec) {
  refuseUnknown(node, {"q_deg", "pull"});
  const int joints = spec.nominal.joints();
  ListedPosture posture{jointNumbers(node, "q_deg", joints, io::kDegree), optionalDirection(node, "pull")};
  for (int i = 0; i < joints; ++i) {
    const robot::JointLimits& limits = spec.nominal.limits[static_cast<std::size_t>(i)];
    if (posture.q[i] < limits.lower || posture.q[i] > limits.upper) {
      node.refuse("q_deg", node.requiredAttribute("q_deg"),
                  "expected joint " + std::to_string(i + 1) + " within the limits of the URDF");
    }
  }
  spec.postures.push_back(posture);
}

PostureDraw readDraw(const io::XmlNode& node, int joints) {
  refuseUnknown(node,
                {"count", "candidates", "min_deg", "max_deg", "min_abs_sin_q5", "max_flange_up_deg", "min_height_mm",
                 "max_height_mm", "min_tracker_distance_mm", "max_tracker_distance_mm", "min_hang_clearance_mm"});
  PostureDraw draw(joints);
  draw.count = integer(node, "count", 1, kMost);
  draw.candidates = integer(node, "candidates", 1, 1000, 1);
  draw.low = jointNumbers(node, "min_deg", joints, io::kDegree);
  draw.high = jointNumbers(node, "max_deg", joints, io::kDegree);
  if ((draw.high - draw.low).minCoeff() < 0.0) {
    node.refuse("max_deg", node.requiredAttribute("max_deg"), "expected no angle below that of min_deg");
  }
  draw.min_abs_sin_bend = nonNegativeOr(node, "min_abs_sin_q5", 1.0, 0.0);
  if (draw.min_abs_sin_bend > 0.0 && robot::wristJointsOf(joints) < 3) {
    node.refuse("min_abs_sin_q5", node.requiredAttribute("min_abs_sin_q5"),
                "expected it left out: the wrist of a machine of " + std::to_string(joints) +
                    " joints has two axes, no third that a bend could bring in line");
  }
  draw.max_flange_up = optionalNumber(node, "max_flange_up_deg", io::kDegree);
  draw.min_height = optionalNumber(node, "min_height_mm", io::kMillimetre);
  draw.max_height = optionalNumber(node, "max_height_mm", io::kMillimetre);
  draw.min_tracker_distance = optionalNumber(node, "min_tracker_distance_mm", io::kMillimetre);
  draw.max_tracker_distance = optionalNumber(node, "max_tracker_distance_mm", io::kMillimetre);
  draw.min_hang_clearance = optionalNumber(node, "min_hang_clearance_mm", io::kMillimetre);
  return draw;
}

/// A cable without anchor needs to be told where it pulls.
void requirePullDirections(const io::XmlNode& postures, const SimulationSpec& spec) {
  const auto* cable = spec.loading ? std::get_if<CablePull>(&spec.loading->load) : nullptr;
  if (cable == nullptr || cable->anchor || cable->direction) return;
  const std::string expectation = "expected a direction: cable_load has neither anchor_mm nor direction";
  for (const io::XmlNode& node : postures.children("posture")) {
    if (!node.has("pull")) node.refuse("pull", "", expectation);
  }
  if (const auto node = postures.child("draw")) node->refuse("draw", "", expectation);
}

}  // namespace

std::optional<LoadingSpec> readLoading(const io::XmlNode& root) {
  const std::optional<io::XmlNode> hanging = root.child("hanging_load");
  const std::optional<io::XmlNode> cable = root.child("cable_load");
  if (hanging && cable) cable->refuse("cable_load", "", "expected hanging_load or cable_load, not both");
  if (!hanging && !cable) return std::nullopt;
  const io::XmlNode& node = hanging ? *hanging : *cable;
  LoadingSpec loading;
  if (hanging) {
    refuseUnknown(node, {"masses_kg", "hook_mm", "return_to_zero", "repeats"}, {"swing"});
    readSwing(node, loading);
    loading.load = HangingWeights{steps(node, "masses_kg")};
  } else {
    refuseUnknown(node, {"tensions_n", "hook_mm", "anchor_mm", "direction", "return_to_zero", "repeats"});
    loading.load = readCable(node);
  }
  loading.hook_in_flange = node.vector("hook_mm") * io::kMillimetre;
  loading.return_to_zero = flag(node, "return_to_zero", true);
  loading.repeats = integer(node, "repeats", 1, 1000, 3);
  return loading;
}

void readPostures(const io::XmlNode& root, SimulationSpec& spec) {
  const std::optional<io::XmlNode> postures = root.child("postures");
  if (!postures) {
    if (spec.loading) root.refuse("postures", "", "expected postures where the load is hung");
    return;
  }
  refuseUnknown(*postures, {"repeats"}, {"posture", "draw"});
  if (spec.loading && postures->has("repeats")) {
    postures->refuse("repeats", postures->requiredAttribute("repeats"), "expected none: the load has its repeats");
  }
  spec.unloaded_repeats = integer(*postures, "repeats", 1, 1000, spec.unloaded_repeats);
  for (const io::XmlNode& node : postures->children("posture")) readListed(node, spec);
  if (const auto node = postures->child("draw")) spec.posture_draw = readDraw(*node, spec.nominal.joints());
  if (spec.postures.empty() && !spec.posture_draw) {
    postures->refuse("postures", "", "expected posture or draw in it");
  }
  requirePullDirections(*postures, spec);
}

void readSwing(const io::XmlNode& load, LoadingSpec& loading) {
  const auto node = load.child("swing");
  if (!node) return;
  refuseUnknown(*node, {"angle_deg", "period_s"});
  loading.swing = node->number("angle_deg") * io::kDegree;
  loading.swing_period = positive(*node, "period_s", 1.0);
}

std::vector<CircleSweepSpec> readCircleSweeps(const io::XmlNode& root, int joints) {
  std::vector<CircleSweepSpec> sweeps;
  for (const io::XmlNode& node : root.children("circle_sweep")) {
    refuseUnknown(node, {"axis", "start_deg", "stop_deg", "count", "others_deg"});
    CircleSweepSpec sweep;
    sweep.axis = integer(node, "axis", 1, joints) - 1;
    for (const CircleSweepSpec& other : sweeps) {
      if (other.axis == sweep.axis) {
        node.refuse("axis", node.requiredAttribute("axis"), "expected one sweep an axis");
      }
    }
    sweep.start = node.number("start_deg") * io::kDegree;
    sweep.stop = node.number("stop_deg") * io::kDegree;
    sweep.count = integer(node, "count", 2, 100000);
    sweep.others = JointVector::Zero(joints);
    if (node.has("others_deg")) sweep.others = jointNumbers(node, "others_deg", joints, io::kDegree);
    sweeps.push_back(sweep);
  }
  return sweeps;
}

namespace {

/// Angles of the wrist or of what carries it, which of six joints are three each, as any vector.
JointVector partAngles(const io::XmlNode& node, const std::string& attribute, int count) {
  if (count == 3) return node.vector(attribute) * io::kDegree;
  return jointNumbers(node, attribute, count, io::kDegree);
}

}  // namespace

std::optional<WristSweepSpec> readWristSweep(const io::XmlNode& root, int joints, std::size_t targets) {
  const std::optional<io::XmlNode> node = root.child("wrist_sweep");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"readings", "scheme", "arm_deg", "min_deg", "max_deg"});
  WristSweepSpec sweep;
  const int count = static_cast<int>(targets);
  sweep.readings = integer(*node, "readings", count, 1000000);
  if (node->has("scheme")) {
    sweep.scheme = choice<WristScheme>(
        *node, "scheme", {{"one_target", WristScheme::one_target}, {"all_targets", WristScheme::all_targets}});
  }
  if (sweep.scheme == WristScheme::all_targets && sweep.readings % count != 0) {
    node->refuse("readings", node->requiredAttribute("readings"),
                 "expected a multiple of the number of targets for all_targets");
  }
  const int arm = robot::armJointsOf(joints), wrist = joints - arm;
  sweep.arm = JointVector::Zero(arm);
  if (node->has("arm_deg")) sweep.arm = partAngles(*node, "arm_deg", arm);
  sweep.low = partAngles(*node, "min_deg", wrist);
  sweep.high = partAngles(*node, "max_deg", wrist);
  if ((sweep.high - sweep.low).minCoeff() < 0.0) {
    node->refuse("max_deg", node->requiredAttribute("max_deg"), "expected no angle below that of min_deg");
  }
  return sweep;
}

namespace {

/// Throws InputError where the carriage does not stay between the supports.
std::optional<RailBeam> readRailBeam(const io::XmlNode& of_rail, const RailSpec& rail) {
  const std::optional<io::XmlNode> node = of_rail.child("beam");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"from_mm", "to_mm", "bending_up_nm2", "bending_level_nm2", "torsion_nm2"});
  RailBeam beam;
  beam.from = node->number("from_mm") * io::kMillimetre;
  beam.to = node->number("to_mm") * io::kMillimetre;
  beam.bending_up = positive(*node, "bending_up_nm2", 1.0);
  beam.bending_level = positive(*node, "bending_level_nm2", 1.0);
  beam.torsion = optionalPositive(*node, "torsion_nm2", 1.0);
  for (const double position : {rail.low, rail.high, rail.sweeps_at}) {
    if (carries(beam, position)) continue;
    node->refuse("from_mm", node->requiredAttribute("from_mm"),
                 fmt::format("expected supports on either side of the carriage, which also stands at {:g} mm: clear of "
                             "them by a hundredth of the span",
                             position / io::kMillimetre));
  }
  return beam;
}

}  // namespace

RailSpec readRail(const io::XmlNode& root, const robot::Robot& robot) {
  RailSpec rail;
  const std::optional<io::XmlNode> node = root.child("rail");
  if (!node) return rail;
  if (!robot.rail) node->refuse("rail", "", "expected a URDF with a prismatic joint before all that turn");
  refuseUnknown(*node,
                {"sweeps_at_mm", "min_mm", "max_mm", "stops", "tilt_deg", "scale_error", "straightness_um", "wave_mm",
                 "stop_sigma_um"},
                {"beam"});
  rail.sweeps_at = numberOr(*node, "sweeps_at_mm", io::kMillimetre, 0.0);
  rail.low = numberOr(*node, "min_mm", io::kMillimetre, 0.0);
  rail.high = numberOr(*node, "max_mm", io::kMillimetre, rail.low);
  if (rail.high < rail.low) {
    node->refuse("max_mm", node->requiredAttribute("max_mm"), "expected no position below that of min_mm");
  }
  constexpr int kFewestStops = 3, kMostStops = 10000;
  if (node->has("stops")) rail.stops = integer(*node, "stops", kFewestStops, kMostStops);
  rail.tilt = vectorOr(*node, "tilt_deg", io::kDegree, Eigen::Vector3d::Zero());
  rail.scale = 1.0 + numberOr(*node, "scale_error", 1.0, 0.0);
  rail.straightness = nonNegativeOr(*node, "straightness_um", io::kMicrometre, 0.0);
  rail.wave = optionalPositive(*node, "wave_mm", io::kMillimetre).value_or(rail.wave);
  rail.stop_sigma = nonNegativeOr(*node, "stop_sigma_um", io::kMicrometre, 0.0);
  rail.beam = readRailBeam(*node, rail);
  return rail;
}

void readNestsAndTimes(const io::XmlNode& root, SimulationSpec& spec) {
  if (const auto nests = root.child("nests")) {
    refuseUnknown(*nests, {"interval_s", "after_sweeps"}, {"nest"});
    spec.nests_after_sweeps = flag(*nests, "after_sweeps", false);
    spec.timing.nest_interval_s = optionalPositive(*nests, "interval_s", 1.0).value_or(3600.0);
    for (const io::XmlNode& node : nests->children("nest")) {
      refuseUnknown(node, {"id", "xyz_mm"});
      const std::string id = node.requiredName("id");
      for (const NestSpec& other : spec.nests) {
        if (other.id == id) node.refuse("id", id, "expected every nest once");
      }
      spec.nests.push_back({id, node.vector("xyz_mm") * io::kMillimetre});
    }
  }
  if (const auto times = root.child("times")) {
    refuseUnknown(*times, {"reading_s", "move_s", "load_change_s"});
    spec.timing.reading_s = optionalPositive(*times, "reading_s", 1.0).value_or(spec.timing.reading_s);
    spec.timing.move_s = nonNegativeOr(*times, "move_s", 1.0, spec.timing.move_s);
    spec.timing.load_change_s = nonNegativeOr(*times, "load_change_s", 1.0, spec.timing.load_change_s);
  }
}

namespace {

void readRobot(const io::XmlNode& root, const std::filesystem::path& folder, SimulationSpec& spec) {
  using namespace simulation;
  const io::XmlNode node = root.requiredChild("robot");
  refuseUnknown(
      node, {"urdf", "base_link", "flange_link", "double_encoder", "double_encoder_joints", "read_back_resolution_deg"},
      {"early_log"});
  spec.urdf_file = folder / node.requiredName("urdf");
  spec.base_link = node.requiredName("base_link");
  spec.flange_link = node.requiredName("flange_link");
  if (node.has("double_encoder")) {
    spec.double_encoder = choice<campaign::DoubleEncoder>(node, "double_encoder",
                                                          {{"active", campaign::DoubleEncoder::active},
                                                           {"inactive", campaign::DoubleEncoder::inactive},
                                                           {"unspecified", campaign::DoubleEncoder::unspecified}});
  }
  spec.read_back_resolution = nonNegativeOr(node, "read_back_resolution_deg", io::kDegree, 0.0);
  spec.nominal = robot::readUrdf(spec.urdf_file, spec.base_link, spec.flange_link);
  const std::vector<campaign::JointNumber> encoders = campaign::readDoubleEncoderJoints(node);
  campaign::requireJoints(encoders, spec.nominal.joints());
  for (const campaign::JointNumber& encoder : encoders) spec.double_encoder_joints.push_back(encoder.joint);
  spec.early_log = readEarlyLog(node, spec.nominal.joints());
}

/// A gear is what lies before the second encoder.
void requireEncodersOfGears(const io::XmlNode& root, const SimulationSpec& spec) {
  const std::vector<int>& encoders = spec.double_encoder_joints;
  if (encoders.empty()) return;
  for (int joint = 0; joint < static_cast<int>(spec.machine.joints.size()); ++joint) {
    const bool has = std::find(encoders.begin(), encoders.end(), joint) != encoders.end();
    if (has || !spec.machine.joints[static_cast<std::size_t>(joint)].gear) continue;
    const io::XmlNode robot = root.requiredChild("robot");
    robot.refuse("double_encoder_joints", robot.requiredAttribute("double_encoder_joints"),
                 "expected joint " + std::to_string(joint + 1) + " among them: it has a gear");
  }
}

}  // namespace

SimulationSpec readSimulationSpec(const std::filesystem::path& file) {
  return parseSimulationSpec(io::readTextFile(file, io::kLargestXml), file);
}

SimulationSpec parseSimulationSpec(std::string_view bytes, const std::filesystem::path& file) {
  using namespace simulation;
  const io::XmlFile xml(file.string(), bytes);
  const io::XmlNode root = xml.root();
  if (root.name() != "simulation") root.refuse(root.name(), "", "expected the root element 'simulation'");
  refuseUnknown(root, {"format", "name", "date", "seed", "measurement"},
                {"robot",       "joints",   "base",      "link",         "geometry",   "tool",        "tool_plate",
                 "loose_plate", "coupling", "spring",    "growth",       "creep",      "temperature", "targets",
                 "tracker",     "station",  "load_cell", "hanging_load", "cable_load", "postures",    "circle_sweep",
                 "wrist_sweep", "rail",     "nests",     "times"});
  integer(root, "format", 1, 1);

  SimulationSpec spec;
  spec.file = file;
  spec.name = root.requiredName("name");
  spec.date = root.requiredName("date");
  spec.seed = integer64(root, "seed");
  spec.measurement = integer64(root, "measurement", 1);
  readRobot(root, file.parent_path(), spec);
  spec.temperature = readTemperature(root);
  spec.machine = readMachine(root, spec.nominal.joints());
  requireEncodersOfGears(root, spec);
  spec.targets = readTargets(root);
  spec.tracker = readTracker(root);
  spec.station = readStation(root);
  spec.load_cell = readLoadCell(root, spec.nominal);
  spec.loading = readLoading(root);
  spec.rail = readRail(root, spec.nominal);
  readPostures(root, spec);
  spec.circle_sweeps = readCircleSweeps(root, spec.nominal.joints());
  spec.wrist_sweep = readWristSweep(root, spec.nominal.joints(), spec.targets.size());
  readNestsAndTimes(root, spec);
  constexpr std::size_t kFewestNests = 3;
  if (!spec.tracker.later.empty() && spec.nests.size() < kFewestNests) {
    root.refuse("nests", std::to_string(spec.nests.size()),
                "expected at least three nests: they join the stations of the tracker");
  }
  return spec;
}

std::vector<int> rigidJoints(const SimulationSpec& spec) {
  std::vector<int> rigid;
  for (std::size_t j = 0; j < spec.machine.joints.size(); ++j) {
    if (!spec.machine.joints[j].torsion) rigid.push_back(static_cast<int>(j) + 1);
  }
  return rigid;
}

}  // namespace stiffscope::simulation
