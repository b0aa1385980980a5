#include <algorithm>
#include <cmath>

#include "core/io/units.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

int jointsOf(const MachineSpec& machine) { return static_cast<int>(machine.joints.size()); }

JointStages readStages(const io::XmlNode& node) {
  refuseUnknown(node, {"torques_nm", "stiffness_nm_per_rad"});
  JointStages stages;
  stages.torques = numberList(node, "torques_nm", 0, 1.0);
  stages.rates = numberList(node, "stiffness_nm_per_rad", stages.torques.size() + 1, 1.0);
  double before = 0.0;
  for (const double torque : stages.torques) {
    if (!(torque > before)) {
      node.refuse("torques_nm", node.requiredAttribute("torques_nm"), "expected rising numbers above 0");
    }
    before = torque;
  }
  for (const double rate : stages.rates) {
    if (!(rate > 0.0)) {
      node.refuse("stiffness_nm_per_rad", node.requiredAttribute("stiffness_nm_per_rad"),
                  "expected numbers above 0, one more than torques_nm has");
    }
  }
  return stages;
}

JointBacklash readBacklash(const io::XmlNode& node) {
  refuseUnknown(node, {"width_deg", "rest_share"});
  JointBacklash backlash{positive(node, "width_deg", io::kDegree)};
  backlash.rest = optionalPositive(node, "rest_share", 1.0).value_or(backlash.rest);
  if (backlash.rest > 1.0) {
    node.refuse("rest_share", node.requiredAttribute("rest_share"), "expected a share of the stiffness, at most 1");
  }
  return backlash;
}

JointFriction readFriction(const io::XmlNode& node) {
  refuseUnknown(node, {"torque_nm", "stiffness_nm_per_rad", "sliders"});
  return {positive(node, "torque_nm", 1.0), positive(node, "stiffness_nm_per_rad", 1.0),
          integer(node, "sliders", 1, 100, 4)};
}

JointWave readWave(const io::XmlNode& node, const std::string& amplitude, double unit) {
  refuseUnknown(node, {amplitude, "cycles", "phase_deg"});
  return {node.number(amplitude) * unit, optionalPositive(node, "cycles", 1.0).value_or(1.0),
          numberOr(node, "phase_deg", io::kDegree, 0.0)};
}

JointGear readGear(const io::XmlNode& node) {
  refuseUnknown(node, {"stiffness_nm_per_rad", "lost_motion_deg", "encoder_sigma_deg", "encoder_offset_deg"});
  return {positive(node, "stiffness_nm_per_rad", 1.0), nonNegativeOr(node, "lost_motion_deg", io::kDegree, 0.0),
          nonNegativeOr(node, "encoder_sigma_deg", io::kDegree, 0.0),
          numberOr(node, "encoder_offset_deg", io::kDegree, 0.0)};
}

JointRatio readRatio(const io::XmlNode& node, int joint, int joints) {
  refuseUnknown(node, {"share", "of_joint"});
  return {node.number("share"), integer(node, "of_joint", 1, joints, joint + 1) - 1};
}

LostMotion readLostMotion(const io::XmlNode& node) {
  refuseUnknown(node, {"width_deg", "friction_nm"});
  LostMotion play{positive(node, "width_deg", io::kDegree), {}};
  if (node.has("friction_nm")) play.friction = nonNegativeOr(node, "friction_nm", 1.0, 0.0);
  return play;
}

/// What follows the temperature of the day needs one.
void requireTemperature(const io::XmlNode& root, const io::XmlNode& node, const char* attribute) {
  if (!root.child("temperature")) {
    node.refuse(attribute, node.requiredAttribute(attribute), "expected the element temperature beside it");
  }
}

ZeroWarming readZeroWarming(const io::XmlNode& node) {
  refuseUnknown(node, {"deg_per_k", "lag_s"});
  return {node.number("deg_per_k") * io::kDegree, nonNegativeOr(node, "lag_s", 1.0, 0.0)};
}

double shareBelowOne(const io::XmlNode& node) {
  const double share = node.number("share");
  if (!(std::abs(share) < 1.0)) {
    node.refuse("share", node.requiredAttribute("share"), "expected a share between -1 and 1");
  }
  return share;
}

}  // namespace

JointStiffness readJoint(const io::XmlNode& node, int index, int joints) {
  refuseUnknown(node, {"index", "stiffness_nm_per_rad", "bearing_nm_per_rad", "cubic_nm_per_rad3"},
                {"stages", "backlash", "friction", "stiffness_ripple", "angle_error", "softening", "gear", "ratio",
                 "lost_motion", "zero_jump", "zero_warming"});
  JointStiffness joint;
  joint.torsion = optionalPositive(node, "stiffness_nm_per_rad", 1.0);
  joint.bearing = optionalPositive(node, "bearing_nm_per_rad", 1.0);
  joint.cubic = nonNegativeOr(node, "cubic_nm_per_rad3", 1.0, 0.0);
  if (const auto child = node.child("stages")) joint.stages = readStages(*child);
  if (const auto child = node.child("backlash")) joint.backlash = readBacklash(*child);
  if (const auto child = node.child("friction")) joint.friction = readFriction(*child);
  if (const auto child = node.child("stiffness_ripple")) {
    joint.rate_wave = readWave(*child, "share", 1.0);
    shareBelowOne(*child);
  }
  if (const auto child = node.child("angle_error")) {
    joint.angle_wave = readWave(*child, "amplitude_deg", io::kDegree);
  }
  if (const auto child = node.child("softening")) {
    refuseUnknown(*child, {"share", "time_constant_s"});
    joint.softening = JointSoftening{shareBelowOne(*child), positive(*child, "time_constant_s", 1.0)};
  }
  if (const auto child = node.child("gear")) joint.gear = readGear(*child);
  if (const auto child = node.child("ratio")) joint.ratio = readRatio(*child, index, joints);
  if (const auto child = node.child("lost_motion")) joint.lost_motion = readLostMotion(*child);
  if (const auto child = node.child("zero_jump")) {
    refuseUnknown(*child, {"angle_deg", "at_s"});
    joint.zero_jump = ZeroJump{child->number("angle_deg") * io::kDegree, child->number("at_s")};
  }
  if (const auto child = node.child("zero_warming")) joint.zero_warming = readZeroWarming(*child);
  const bool needs_torsion =
      joint.cubic > 0.0 || joint.stages || joint.backlash || joint.friction || joint.rate_wave || joint.softening;
  if (needs_torsion && !joint.torsion) {
    node.refuse("stiffness_nm_per_rad", "", "expected a stiffness: this joint's other elements build on it");
  }
  return joint;
}

namespace {

void readJoints(const io::XmlNode& root, MachineSpec& machine) {
  const std::optional<io::XmlNode> joints = root.child("joints");
  if (!joints) return;
  const int count = jointsOf(machine);
  refuseUnknown(*joints, {"mass_relative_sigma"}, {"joint"});
  machine.mass_relative_sigma = nonNegativeOr(*joints, "mass_relative_sigma", 1.0, 0.0);
  PerJoint<bool> seen(machine.joints.size(), false);
  for (const io::XmlNode& node : joints->children("joint")) {
    const int index = integer(node, "index", 1, count) - 1;
    const auto joint = static_cast<std::size_t>(index);
    if (seen[joint]) node.refuse("index", node.requiredAttribute("index"), "expected every joint at most once");
    seen[joint] = true;
    machine.joints[joint] = readJoint(node, index, count);
    if (machine.joints[joint].zero_warming) requireTemperature(root, *node.child("zero_warming"), "deg_per_k");
  }
}

void readBase(const io::XmlNode& root, MachineSpec& machine) {
  const std::optional<io::XmlNode> base = root.child("base");
  if (!base) return;
  refuseUnknown(*base, {"rotation_nm_per_rad", "translation_n_per_m", "tilt_deg", "tilt_azimuth_deg", "tilt_declared"},
                {"contact"});
  const auto stiffness = [&](const char* name) -> std::optional<Eigen::Vector3d> {
    if (!base->has(name)) return std::nullopt;
    const Eigen::Vector3d three = base->vector(name);
    if (!(three.minCoeff() > 0.0)) {
      base->refuse(name, base->requiredAttribute(name), "expected three numbers above 0");
    }
    return three;
  };
  machine.base_rotation = stiffness("rotation_nm_per_rad");
  machine.base_translation = stiffness("translation_n_per_m");
  readBaseContacts(*base, machine);
  machine.base_tilt = numberOr(*base, "tilt_deg", io::kDegree, 0.0);
  machine.base_tilt_azimuth = numberOr(*base, "tilt_azimuth_deg", io::kDegree, 0.0);
  machine.base_tilt_declared = flag(*base, "tilt_declared", false);
}

void readLinks(const io::XmlNode& root, MachineSpec& machine) {
  for (const io::XmlNode& node : root.children("link")) {
    refuseUnknown(node, {"after_joint", "bending_nm2", "torsion_nm2", "shear_n", "axial_n"});
    LinkBeam beam;
    beam.joint = integer(node, "after_joint", 1, jointsOf(machine)) - 1;
    for (const LinkBeam& other : machine.links) {
      if (other.joint == beam.joint) {
        node.refuse("after_joint", node.requiredAttribute("after_joint"), "expected every link at most once");
      }
    }
    beam.bending = optionalPositive(node, "bending_nm2", 1.0);
    beam.torsion = optionalPositive(node, "torsion_nm2", 1.0);
    beam.shear = optionalPositive(node, "shear_n", 1.0);
    beam.axial = optionalPositive(node, "axial_n", 1.0);
    if (beam.shear && !beam.bending) {
      node.refuse("shear_n", node.requiredAttribute("shear_n"), "expected bending_nm2 beside it");
    }
    if (!beam.bending && !beam.torsion && !beam.axial) {
      node.refuse("link", "", "expected bending_nm2, torsion_nm2 or axial_n");
    }
    machine.links.push_back(beam);
  }
}

void readGeometry(const io::XmlNode& root, MachineSpec& machine) {
  const std::optional<io::XmlNode> node = root.child("geometry");
  if (!node) return;
  refuseUnknown(*node, {"position_sigma_mm", "direction_sigma_deg", "zero_sigma_deg", "wrist_position_sigma_mm"},
                {"axis"});
  GeometryErrors& geometry = machine.geometry;
  geometry.position_sigma = nonNegativeOr(*node, "position_sigma_mm", io::kMillimetre, 0.0);
  geometry.direction_sigma = nonNegativeOr(*node, "direction_sigma_deg", io::kDegree, 0.0);
  geometry.zero_sigma = nonNegativeOr(*node, "zero_sigma_deg", io::kDegree, 0.0);
  if (node->has("wrist_position_sigma_mm")) {
    geometry.wrist_position_sigma = nonNegativeOr(*node, "wrist_position_sigma_mm", io::kMillimetre, 0.0);
  }
  for (const io::XmlNode& axis : node->children("axis")) {
    refuseUnknown(axis, {"index", "offset_mm", "tilt_deg", "zero_deg"});
    const auto index = static_cast<std::size_t>(integer(axis, "index", 1, jointsOf(machine)) - 1);
    if (geometry.listed[index]) {
      axis.refuse("index", axis.requiredAttribute("index"), "expected every axis at most once");
    }
    geometry.listed[index] = AxisError{vectorOr(axis, "offset_mm", io::kMillimetre, Eigen::Vector3d::Zero()),
                                       vectorOr(axis, "tilt_deg", io::kDegree, Eigen::Vector3d::Zero()),
                                       numberOr(axis, "zero_deg", io::kDegree, 0.0)};
  }
}

}  // namespace

MachineSpec readMachine(const io::XmlNode& root, int joints) {
  MachineSpec machine;
  machine.joints.resize(static_cast<std::size_t>(joints));
  readJoints(root, machine);
  readBase(root, machine);
  readLinks(root, machine);
  readGeometry(root, machine);
  if (const std::optional<io::XmlNode> tool = root.child("tool")) {
    refuseUnknown(*tool, {"mass_kg", "com_mm"});
    machine.tool.mass_kg = positive(*tool, "mass_kg", 1.0);
    machine.tool.com_in_flange = vectorOr(*tool, "com_mm", io::kMillimetre, Eigen::Vector3d::Zero());
  }
  if (const auto plate = root.child("tool_plate")) machine.tool_plate = readToolPlate(*plate);
  if (const auto plate = root.child("loose_plate")) machine.loose_plate = readLoosePlate(*plate);
  readSprings(root, machine);
  readSlowChanges(root, machine);
  return machine;
}

namespace {

SharedSpring readSharedSpring(const io::XmlNode& node, const MachineSpec& machine) {
  refuseUnknown(node, {"joints", "rod_n_per_m", "crank_mm", "shaft_nm_per_rad", "ratios"});
  SharedSpring spring;
  const std::vector<double> joints = numberList(node, "joints", 2, 1.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const int joint = static_cast<int>(joints[k]) - 1;
    const bool exists = joints[k] >= 1.0 && joints[k] <= jointsOf(machine) && joints[k] == joint + 1;
    if (!exists || joints[0] == joints[1]) {
      node.refuse("joints", node.requiredAttribute("joints"),
                  "expected two different joints from 1 to " + std::to_string(jointsOf(machine)));
    }
    if (!machine.joints[static_cast<std::size_t>(joint)].torsion) {
      node.refuse("joints", node.requiredAttribute("joints"), "expected joints that have stiffness_nm_per_rad");
    }
    spring.joints[k] = joint;
  }
  const bool rod = node.has("rod_n_per_m");
  if (rod == node.has("shaft_nm_per_rad")) {
    node.refuse("coupling", "", "expected rod_n_per_m with crank_mm, or shaft_nm_per_rad with ratios");
  }
  spring.rate = positive(node, rod ? "rod_n_per_m" : "shaft_nm_per_rad", 1.0);
  const std::vector<double> arms =
      rod ? numberList(node, "crank_mm", 2, io::kMillimetre) : numberList(node, "ratios", 2, 1.0);
  spring.arms = {arms[0], arms[1]};
  return spring;
}

CylinderGas readGas(const io::XmlNode& node) {
  CylinderGas gas;
  gas.pressure = positive(node, "gas_pressure_bar", io::kBar);
  gas.area = positive(node, "gas_area_cm2", io::kSquareCentimetre);
  gas.volume = positive(node, "gas_volume_l", io::kLitre);
  if (node.has("gas_exponent")) gas.exponent = positive(node, "gas_exponent", 1.0);
  if (gas.exponent < 1.0) node.refuse("gas_exponent", node.requiredAttribute("gas_exponent"), "expected 1 or more");
  gas.pushes = choice<bool>(node, "gas_acts", {{"pull", false}, {"push", true}});
  return gas;
}

/// What a campaign can declare is one of the two laws.
void requireOneLaw(const io::XmlNode& node, const LinkSpring& spring) {
  if (spring.gas && (spring.rate != 0.0 || spring.tension != 0.0))
    node.refuse("declared", "true", "expected gas without rate_n_per_m and tension_n beside it, or those without gas");
}

LinkSpring readLinkSpring(const io::XmlNode& node, const MachineSpec& machine) {
  const std::vector<std::string> of_gas{"gas_pressure_bar", "gas_area_cm2", "gas_volume_l", "gas_exponent", "gas_acts"};
  std::vector<std::string> known{"from_body", "to_body", "from_mm", "to_mm", "rate_n_per_m", "tension_n", "declared"};
  known.insert(known.end(), of_gas.begin(), of_gas.end());
  refuseUnknown(node, known);
  LinkSpring spring;
  spring.from_body = integer(node, "from_body", 0, jointsOf(machine));
  spring.to_body = integer(node, "to_body", 0, jointsOf(machine));
  if (spring.to_body <= spring.from_body) {
    node.refuse("to_body", node.requiredAttribute("to_body"), "expected a body beyond from_body");
  }
  spring.from_in_base_at_zero = node.vector("from_mm") * io::kMillimetre;
  spring.to_in_base_at_zero = node.vector("to_mm") * io::kMillimetre;
  if ((spring.to_in_base_at_zero - spring.from_in_base_at_zero).norm() < 1e-3) {
    node.refuse("to_mm", node.requiredAttribute("to_mm"), "expected a point at least 1 mm from from_mm");
  }
  spring.rate = nonNegativeOr(node, "rate_n_per_m", 1.0, 0.0);
  spring.tension = numberOr(node, "tension_n", 1.0, 0.0);
  if (std::any_of(of_gas.begin(), of_gas.end(), [&](const std::string& name) { return node.has(name); }))
    spring.gas = readGas(node);
  spring.declared = flag(node, "declared", false);
  if (spring.declared) requireOneLaw(node, spring);
  return spring;
}

}  // namespace

void readSprings(const io::XmlNode& root, MachineSpec& machine) {
  for (const io::XmlNode& node : root.children("coupling")) {
    machine.shared_springs.push_back(readSharedSpring(node, machine));
  }
  for (const io::XmlNode& node : root.children("spring")) machine.link_springs.push_back(readLinkSpring(node, machine));
}

void readBaseContacts(const io::XmlNode& base, MachineSpec& machine) {
  for (const io::XmlNode& node : base.children("contact")) {
    refuseUnknown(node, {"axis", "side", "stiffness_nm_per_rad", "gap_deg"});
    OneSidedContact contact;
    contact.axis = choice<int>(node, "axis", {{"x", 0}, {"y", 1}, {"z", 2}});
    contact.positive = choice<bool>(node, "side", {{"positive", true}, {"negative", false}});
    contact.stiffness = positive(node, "stiffness_nm_per_rad", 1.0);
    contact.gap = nonNegativeOr(node, "gap_deg", io::kDegree, 0.0);
    if (!machine.base_rotation) node.refuse("contact", "", "expected rotation_nm_per_rad of the base beside it");
    machine.base_contacts.push_back(contact);
  }
}

ToolPlate readToolPlate(const io::XmlNode& node) {
  refuseUnknown(node, {"translation_n_per_m", "rotation_nm_per_rad"});
  ToolPlate plate{node.vector("translation_n_per_m"), node.vector("rotation_nm_per_rad")};
  for (const char* name : {"translation_n_per_m", "rotation_nm_per_rad"}) {
    if (!(node.vector(name).minCoeff() > 0.0)) {
      node.refuse(name, node.requiredAttribute(name), "expected three numbers above 0");
    }
  }
  return plate;
}

LoosePlate readLoosePlate(const io::XmlNode& node) {
  refuseUnknown(node, {"direction", "shift_um", "turn_deg"});
  node.requiredAttribute("direction");
  return {*optionalDirection(node, "direction"), vectorOr(node, "shift_um", io::kMicrometre, Eigen::Vector3d::Zero()),
          vectorOr(node, "turn_deg", io::kDegree, Eigen::Vector3d::Zero())};
}

namespace {

ThermalGrowth readGrowth(const io::XmlNode& root, const io::XmlNode& node, int joints) {
  refuseUnknown(node, {"after_joint", "growth_mm", "time_constant_s", "growth_mm_per_k"});
  ThermalGrowth growth;
  growth.joint = integer(node, "after_joint", 1, joints - 1) - 1;
  if (node.has("growth_mm_per_k")) {
    growth.per_kelvin = node.number("growth_mm_per_k") * io::kMillimetre;
    requireTemperature(root, node, "growth_mm_per_k");
    if (!node.has("growth_mm")) return growth;
  }
  growth.growth = node.number("growth_mm") * io::kMillimetre;
  growth.time_constant = positive(node, "time_constant_s", 1.0);
  return growth;
}

}  // namespace

void readSlowChanges(const io::XmlNode& root, MachineSpec& machine) {
  for (const io::XmlNode& node : root.children("growth"))
    machine.growths.push_back(readGrowth(root, node, jointsOf(machine)));
  if (const auto node = root.child("creep")) {
    refuseUnknown(*node, {"share", "time_constant_s"});
    const double share = positive(*node, "share", 1.0);
    if (share > 1.0) node->refuse("share", node->requiredAttribute("share"), "expected a share, at most 1");
    machine.creep = Creep{share, positive(*node, "time_constant_s", 1.0)};
  }
}

}  // namespace stiffscope::simulation
