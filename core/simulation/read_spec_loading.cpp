#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

constexpr int kMost = 1000000;  ///< of anything that is counted

std::vector<double> steps(const XmlNode& node, const std::string& attribute) {
  const std::vector<double> values = numberList(node, attribute, 0, 1.0);
  for (const double value : values) {
    if (!(value > 0.0)) {
      node.refuse(attribute, node.requiredAttribute(attribute),
                  "expected numbers above 0, one a step (the unloaded step 0 and the return are not listed)");
    }
  }
  return values;
}

CablePull readCable(const XmlNode& node) {
  CablePull cable{steps(node, "tensions_n"), std::nullopt, optionalDirection(node, "direction")};
  if (node.has("anchor_mm")) cable.anchor = node.vector("anchor_mm") * kMillimetre;
  if (cable.anchor && cable.direction) {
    node.refuse("direction", node.requiredAttribute("direction"),
                "expected anchor_mm or direction, not both");
  }
  return cable;
}

Vector6d jointAngles(const XmlNode& node, const std::string& attribute) {
  const std::vector<double> values = numberList(node, attribute, 6, kDegree);
  return Eigen::Map<const Vector6d>(values.data());
}

void readListed(const XmlNode& node, SimulationSpec& spec) {
  refuseUnknown(node, {"q_deg", "pull"});
  ListedPosture posture{jointAngles(node, "q_deg"), optionalDirection(node, "pull")};
  for (int i = 0; i < 6; ++i) {
    const JointLimits& limits = spec.nominal.limits[i];
    if (posture.q[i] < limits.lower || posture.q[i] > limits.upper) {
      node.refuse("q_deg", node.requiredAttribute("q_deg"),
                  "expected joint " + std::to_string(i + 1) + " within the limits of the URDF");
    }
  }
  spec.postures.push_back(posture);
}

PostureDraw readDraw(const XmlNode& node) {
  refuseUnknown(node, {"count", "candidates", "min_deg", "max_deg", "min_abs_sin_q5", "max_flange_up_deg",
                       "min_height_mm", "max_height_mm", "min_tracker_distance_mm", "max_tracker_distance_mm",
                       "min_hang_clearance_mm"});
  PostureDraw draw;
  draw.count = integer(node, "count", 1, kMost);
  draw.candidates = integer(node, "candidates", 1, 1000, 1);
  draw.low = jointAngles(node, "min_deg");
  draw.high = jointAngles(node, "max_deg");
  if ((draw.high - draw.low).minCoeff() < 0.0) {
    node.refuse("max_deg", node.requiredAttribute("max_deg"), "expected no angle below that of min_deg");
  }
  draw.min_abs_sin_q5 = nonNegativeOr(node, "min_abs_sin_q5", 1.0, 0.0);
  draw.max_flange_up = optionalNumber(node, "max_flange_up_deg", kDegree);
  draw.min_height = optionalNumber(node, "min_height_mm", kMillimetre);
  draw.max_height = optionalNumber(node, "max_height_mm", kMillimetre);
  draw.min_tracker_distance = optionalNumber(node, "min_tracker_distance_mm", kMillimetre);
  draw.max_tracker_distance = optionalNumber(node, "max_tracker_distance_mm", kMillimetre);
  draw.min_hang_clearance = optionalNumber(node, "min_hang_clearance_mm", kMillimetre);
  return draw;
}

/// A cable without anchor needs to be told where it pulls.
void requirePullDirections(const XmlNode& postures, const SimulationSpec& spec) {
  const auto* cable = spec.loading ? std::get_if<CablePull>(&spec.loading->load) : nullptr;
  if (cable == nullptr || cable->anchor || cable->direction) return;
  const std::string expectation = "expected a direction: cable_load has neither anchor_mm nor direction";
  for (const XmlNode& node : postures.children("posture")) {
    if (!node.has("pull")) node.refuse("pull", "", expectation);
  }
  if (const auto node = postures.child("draw")) node->refuse("draw", "", expectation);
}

}  // namespace

std::optional<LoadingSpec> readLoading(const XmlNode& root) {
  const std::optional<XmlNode> hanging = root.child("hanging_load");
  const std::optional<XmlNode> cable = root.child("cable_load");
  if (hanging && cable) cable->refuse("cable_load", "", "expected hanging_load or cable_load, not both");
  if (!hanging && !cable) return std::nullopt;
  const XmlNode& node = hanging ? *hanging : *cable;
  LoadingSpec loading;
  if (hanging) {
    refuseUnknown(node, {"masses_kg", "hook_mm", "return_to_zero", "repeats"}, {"swing"});
    readSwing(node, loading);
    loading.load = HangingWeights{steps(node, "masses_kg")};
  } else {
    refuseUnknown(node, {"tensions_n", "hook_mm", "anchor_mm", "direction", "return_to_zero", "repeats"});
    loading.load = readCable(node);
  }
  loading.hook_in_flange = node.vector("hook_mm") * kMillimetre;
  loading.return_to_zero = flag(node, "return_to_zero", true);
  loading.repeats = integer(node, "repeats", 1, 1000, 3);
  return loading;
}

void readPostures(const XmlNode& root, SimulationSpec& spec) {
  const std::optional<XmlNode> postures = root.child("postures");
  if (!postures) {
    if (spec.loading) root.refuse("postures", "", "expected postures where the load is hung");
    return;
  }
  refuseUnknown(*postures, {}, {"posture", "draw"});
  for (const XmlNode& node : postures->children("posture")) readListed(node, spec);
  if (const auto node = postures->child("draw")) spec.posture_draw = readDraw(*node);
  if (!spec.loading) postures->refuse("postures", "", "expected hanging_load or cable_load beside it");
  if (spec.postures.empty() && !spec.posture_draw) {
    postures->refuse("postures", "", "expected posture or draw in it");
  }
  requirePullDirections(*postures, spec);
}

}  // namespace stiffscope::simulation
