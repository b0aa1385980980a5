#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

void readJoints(const XmlNode& root, MachineSpec& machine) {
  const std::optional<XmlNode> joints = root.child("joints");
  if (!joints) return;
  refuseUnknown(*joints, {"mass_relative_sigma"}, {"joint"});
  machine.mass_relative_sigma = nonNegativeOr(*joints, "mass_relative_sigma", 1.0, 0.0);
  std::array<bool, 6> seen{};
  for (const XmlNode& node : joints->children("joint")) {
    const int joint = integer(node, "index", 1, 6) - 1;
    if (seen[joint])
      node.refuse("index", node.requiredAttribute("index"), "expected every joint at most once");
    seen[joint] = true;
    machine.joints[joint] = readJoint(node);
  }
}

void readBase(const XmlNode& root, MachineSpec& machine) {
  const std::optional<XmlNode> base = root.child("base");
  if (!base) return;
  refuseUnknown(
      *base, {"rotation_nm_per_rad", "translation_n_per_m", "tilt_deg", "tilt_azimuth_deg", "tilt_declared"},
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
  machine.base_tilt = numberOr(*base, "tilt_deg", kDegree, 0.0);
  machine.base_tilt_azimuth = numberOr(*base, "tilt_azimuth_deg", kDegree, 0.0);
  machine.base_tilt_declared = flag(*base, "tilt_declared", false);
}

void readLinks(const XmlNode& root, MachineSpec& machine) {
  for (const XmlNode& node : root.children("link")) {
    refuseUnknown(node, {"after_joint", "bending_nm2", "torsion_nm2", "shear_n", "axial_n"});
    LinkBeam beam;
    beam.joint = integer(node, "after_joint", 1, 6) - 1;
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

void readGeometry(const XmlNode& root, MachineSpec& machine) {
  const std::optional<XmlNode> node = root.child("geometry");
  if (!node) return;
  refuseUnknown(*node,
                {"position_sigma_mm", "direction_sigma_deg", "zero_sigma_deg", "wrist_position_sigma_mm"},
                {"axis"});
  GeometryErrors& geometry = machine.geometry;
  geometry.position_sigma = nonNegativeOr(*node, "position_sigma_mm", kMillimetre, 0.0);
  geometry.direction_sigma = nonNegativeOr(*node, "direction_sigma_deg", kDegree, 0.0);
  geometry.zero_sigma = nonNegativeOr(*node, "zero_sigma_deg", kDegree, 0.0);
  if (node->has("wrist_position_sigma_mm")) {
    geometry.wrist_position_sigma = nonNegativeOr(*node, "wrist_position_sigma_mm", kMillimetre, 0.0);
  }
  for (const XmlNode& axis : node->children("axis")) {
    refuseUnknown(axis, {"index", "offset_mm", "tilt_deg", "zero_deg"});
    const int index = integer(axis, "index", 1, 6) - 1;
    if (geometry.listed[index]) {
      axis.refuse("index", axis.requiredAttribute("index"), "expected every axis at most once");
    }
    geometry.listed[index] = AxisError{vectorOr(axis, "offset_mm", kMillimetre, Eigen::Vector3d::Zero()),
                                       vectorOr(axis, "tilt_deg", kDegree, Eigen::Vector3d::Zero()),
                                       numberOr(axis, "zero_deg", kDegree, 0.0)};
  }
}

}  // namespace

MachineSpec readMachine(const XmlNode& root) {
  MachineSpec machine;
  readJoints(root, machine);
  readBase(root, machine);
  readLinks(root, machine);
  readGeometry(root, machine);
  if (const std::optional<XmlNode> tool = root.child("tool")) {
    refuseUnknown(*tool, {"mass_kg", "com_mm"});
    machine.tool.mass_kg = positive(*tool, "mass_kg", 1.0);
    machine.tool.com_in_flange = vectorOr(*tool, "com_mm", kMillimetre, Eigen::Vector3d::Zero());
  }
  if (const auto plate = root.child("tool_plate")) machine.tool_plate = readToolPlate(*plate);
  readSprings(root, machine);
  readSlowChanges(root, machine);
  return machine;
}

}  // namespace stiffscope::simulation
