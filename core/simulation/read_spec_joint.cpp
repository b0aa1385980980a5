#include <cmath>

#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

JointStages readStages(const XmlNode& node) {
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

JointBacklash readBacklash(const XmlNode& node) {
  refuseUnknown(node, {"width_deg", "rest_share"});
  JointBacklash backlash{positive(node, "width_deg", kDegree)};
  backlash.rest = optionalPositive(node, "rest_share", 1.0).value_or(backlash.rest);
  if (backlash.rest > 1.0) {
    node.refuse("rest_share", node.requiredAttribute("rest_share"),
                "expected a share of the stiffness, at most 1");
  }
  return backlash;
}

JointFriction readFriction(const XmlNode& node) {
  refuseUnknown(node, {"torque_nm", "stiffness_nm_per_rad", "sliders"});
  return {positive(node, "torque_nm", 1.0), positive(node, "stiffness_nm_per_rad", 1.0),
          integer(node, "sliders", 1, 100, 4)};
}

JointWave readWave(const XmlNode& node, const std::string& amplitude, double unit) {
  refuseUnknown(node, {amplitude, "cycles", "phase_deg"});
  return {node.number(amplitude) * unit, optionalPositive(node, "cycles", 1.0).value_or(1.0),
          numberOr(node, "phase_deg", kDegree, 0.0)};
}

double shareBelowOne(const XmlNode& node) {
  const double share = node.number("share");
  if (!(std::abs(share) < 1.0)) {
    node.refuse("share", node.requiredAttribute("share"), "expected a share between -1 and 1");
  }
  return share;
}

}  // namespace

JointStiffness readJoint(const XmlNode& node) {
  refuseUnknown(node, {"index", "stiffness_nm_per_rad", "bearing_nm_per_rad", "cubic_nm_per_rad3"},
                {"stages", "backlash", "friction", "stiffness_ripple", "angle_error", "softening"});
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
    joint.angle_wave = readWave(*child, "amplitude_deg", kDegree);
  }
  if (const auto child = node.child("softening")) {
    refuseUnknown(*child, {"share", "time_constant_s"});
    joint.softening = JointSoftening{shareBelowOne(*child), positive(*child, "time_constant_s", 1.0)};
  }
  const bool needs_torsion = joint.cubic > 0.0 || joint.stages || joint.backlash || joint.friction ||
                             joint.rate_wave || joint.softening;
  if (needs_torsion && !joint.torsion) {
    node.refuse("stiffness_nm_per_rad", "", "expected a stiffness: this joint's other elements build on it");
  }
  return joint;
}

}  // namespace stiffscope::simulation
