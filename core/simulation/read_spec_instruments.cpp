#include <algorithm>

#include "core/input/nearest_name.h"
#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

std::vector<TrueTarget> readTargets(const XmlNode& root) {
  const XmlNode list = root.requiredChild("targets");
  refuseUnknown(list, {}, {"target"});
  std::vector<TrueTarget> targets;
  for (const XmlNode& node : list.children("target")) {
    refuseUnknown(node, {"id", "xyz_mm"}, {"motion"});
    const std::string id = node.requiredName("id");
    for (const TrueTarget& other : targets) {
      if (other.id == id) node.refuse("id", id, "expected every target once");
    }
    targets.push_back({id, node.vector("xyz_mm") * kMillimetre});
    if (const auto motion = node.child("motion")) targets.back().motion = readTargetMotion(*motion);
  }
  if (targets.empty()) list.refuse("target", "", "expected at least one target");
  return targets;
}

TrackerSpec readTracker(const XmlNode& root) {
  const XmlNode node = root.requiredChild("tracker");
  refuseUnknown(node, {"model", "range_fixed_um", "range_per_m_um", "angle_fixed_um", "angle_per_m_um",
                       "true_noise_factor", "xyz_mm", "rpy_deg"});
  TrackerSpec tracker;
  tracker.declared.model = node.requiredName("model");
  tracker.declared.range_fixed = nonNegativeOr(node, "range_fixed_um", kMicrometre, 0.0);
  tracker.declared.range_per_m = nonNegativeOr(node, "range_per_m_um", kMicrometre, 0.0);
  tracker.declared.angle_fixed = nonNegativeOr(node, "angle_fixed_um", kMicrometre, 0.0);
  tracker.declared.angle_per_m = nonNegativeOr(node, "angle_per_m_um", kMicrometre, 0.0);
  tracker.true_noise_factor = nonNegativeOr(node, "true_noise_factor", 1.0, 1.0);
  if (tracker.true_noise_factor > 1000.0) {
    node.refuse("true_noise_factor", node.requiredAttribute("true_noise_factor"), "expected 0 to 1000");
  }
  node.requiredAttribute("xyz_mm");
  node.requiredAttribute("rpy_deg");
  tracker.base_from_tracker = placement(node, "xyz_mm", "rpy_deg");
  return tracker;
}

std::optional<LoadCellSpec> readLoadCell(const XmlNode& root, const Robot& robot) {
  const std::optional<XmlNode> node = root.child("load_cell");
  if (!node) return std::nullopt;
  refuseUnknown(*node,
                {"parent", "xyz_mm", "rpy_deg", "force_sigma_n", "moment_sigma_nm", "true_misalignment_deg",
                 "true_bias_n", "true_bias_nm", "true_gain_error", "true_place_error_mm", "unread_force_n"});
  LoadCellSpec cell;
  cell.declared.parent = node->requiredName("parent");
  std::vector<std::string> links;
  for (const LinkFrame& link : robot.links) links.push_back(link.name);
  if (std::find(links.begin(), links.end(), cell.declared.parent) == links.end()) {
    node->refuse("parent", cell.declared.parent,
                 "expected a link of the robot's chain" + nearestNameHint(cell.declared.parent, links));
  }
  cell.declared.parent_from_cell = placement(*node, "xyz_mm", "rpy_deg");
  node->requiredAttribute("force_sigma_n");
  node->requiredAttribute("moment_sigma_nm");
  cell.declared.force_sigma = nonNegativeOr(*node, "force_sigma_n", 1.0, 0.0);
  cell.declared.moment_sigma = nonNegativeOr(*node, "moment_sigma_nm", 1.0, 0.0);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  cell.misalignment = vectorOr(*node, "true_misalignment_deg", kDegree, zero);
  cell.bias << vectorOr(*node, "true_bias_n", 1.0, zero), vectorOr(*node, "true_bias_nm", 1.0, zero);
  cell.gain_error = numberOr(*node, "true_gain_error", 1.0, 0.0);
  cell.place_error = vectorOr(*node, "true_place_error_mm", kMillimetre, zero);
  cell.unread_force = vectorOr(*node, "unread_force_n", 1.0, zero);
  return cell;
}

}  // namespace stiffscope::simulation
