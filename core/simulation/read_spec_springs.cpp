#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

SharedSpring readSharedSpring(const XmlNode& node, const MachineSpec& machine) {
  refuseUnknown(node, {"joints", "rod_n_per_m", "crank_mm", "shaft_nm_per_rad", "ratios"});
  SharedSpring spring;
  const std::vector<double> joints = numberList(node, "joints", 2, 1.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const int joint = static_cast<int>(joints[k]) - 1;
    const bool exists = joints[k] >= 1.0 && joints[k] <= 6.0 && joints[k] == joint + 1;
    if (!exists || joints[0] == joints[1]) {
      node.refuse("joints", node.requiredAttribute("joints"), "expected two different joints from 1 to 6");
    }
    if (!machine.joints[static_cast<std::size_t>(joint)].torsion) {
      node.refuse("joints", node.requiredAttribute("joints"),
                  "expected joints that have stiffness_nm_per_rad");
    }
    spring.joints[k] = joint;
  }
  const bool rod = node.has("rod_n_per_m");
  if (rod == node.has("shaft_nm_per_rad")) {
    node.refuse("coupling", "", "expected rod_n_per_m with crank_mm, or shaft_nm_per_rad with ratios");
  }
  spring.rate = positive(node, rod ? "rod_n_per_m" : "shaft_nm_per_rad", 1.0);
  const std::vector<double> arms =
      rod ? numberList(node, "crank_mm", 2, kMillimetre) : numberList(node, "ratios", 2, 1.0);
  spring.arms = {arms[0], arms[1]};
  return spring;
}

LinkSpring readLinkSpring(const XmlNode& node) {
  refuseUnknown(node, {"from_body", "to_body", "from_mm", "to_mm", "rate_n_per_m", "tension_n"});
  LinkSpring spring;
  spring.from_body = integer(node, "from_body", 0, 6);
  spring.to_body = integer(node, "to_body", 0, 6);
  if (spring.to_body <= spring.from_body) {
    node.refuse("to_body", node.requiredAttribute("to_body"), "expected a body beyond from_body");
  }
  spring.from_in_base_at_zero = node.vector("from_mm") * kMillimetre;
  spring.to_in_base_at_zero = node.vector("to_mm") * kMillimetre;
  if ((spring.to_in_base_at_zero - spring.from_in_base_at_zero).norm() < 1e-3) {
    node.refuse("to_mm", node.requiredAttribute("to_mm"), "expected a point at least 1 mm from from_mm");
  }
  spring.rate = nonNegativeOr(node, "rate_n_per_m", 1.0, 0.0);
  spring.tension = numberOr(node, "tension_n", 1.0, 0.0);
  return spring;
}

}  // namespace

void readSprings(const XmlNode& root, MachineSpec& machine) {
  for (const XmlNode& node : root.children("coupling")) {
    machine.shared_springs.push_back(readSharedSpring(node, machine));
  }
  for (const XmlNode& node : root.children("spring")) machine.link_springs.push_back(readLinkSpring(node));
}

void readBaseContacts(const XmlNode& base, MachineSpec& machine) {
  for (const XmlNode& node : base.children("contact")) {
    refuseUnknown(node, {"axis", "side", "stiffness_nm_per_rad", "gap_deg"});
    OneSidedContact contact;
    contact.axis = choice<int>(node, "axis", {{"x", 0}, {"y", 1}, {"z", 2}});
    contact.positive = choice<bool>(node, "side", {{"positive", true}, {"negative", false}});
    contact.stiffness = positive(node, "stiffness_nm_per_rad", 1.0);
    contact.gap = nonNegativeOr(node, "gap_deg", kDegree, 0.0);
    if (!machine.base_rotation)
      node.refuse("contact", "", "expected rotation_nm_per_rad of the base beside it");
    machine.base_contacts.push_back(contact);
  }
}

ToolPlate readToolPlate(const XmlNode& node) {
  refuseUnknown(node, {"translation_n_per_m", "rotation_nm_per_rad"});
  ToolPlate plate{node.vector("translation_n_per_m"), node.vector("rotation_nm_per_rad")};
  for (const char* name : {"translation_n_per_m", "rotation_nm_per_rad"}) {
    if (!(node.vector(name).minCoeff() > 0.0)) {
      node.refuse(name, node.requiredAttribute(name), "expected three numbers above 0");
    }
  }
  return plate;
}

void readSlowChanges(const XmlNode& root, MachineSpec& machine) {
  for (const XmlNode& node : root.children("growth")) {
    refuseUnknown(node, {"after_joint", "growth_mm", "time_constant_s"});
    machine.growths.push_back({integer(node, "after_joint", 1, 5) - 1, node.number("growth_mm") * kMillimetre,
                               positive(node, "time_constant_s", 1.0)});
  }
  if (const auto node = root.child("creep")) {
    refuseUnknown(*node, {"share", "time_constant_s"});
    const double share = positive(*node, "share", 1.0);
    if (share > 1.0) node->refuse("share", node->requiredAttribute("share"), "expected a share, at most 1");
    machine.creep = Creep{share, positive(*node, "time_constant_s", 1.0)};
  }
}

}  // namespace stiffscope::simulation
