#include "core/campaign/campaign_sections.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "core/campaign/cell_kind.h"
#include "core/input/roll_pitch_yaw.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

double numberOrZero(const XmlNode& node, const std::string& attribute) {
  return node.has(attribute) ? node.number(attribute) : 0.0;
}

double notNegative(const XmlNode& node, const std::string& attribute) {
  const double value = node.number(attribute);
  if (value < 0.0) node.refuse(attribute, node.requiredAttribute(attribute), "expected 0 or more");
  return value;
}

// The same limits hold for an attribute as for the cells of a table.
void requirePlausible(const XmlNode& node, const std::string& attribute, CellKind kind, double magnitude) {
  const NumberKind& info = numberKind(kind);
  if (magnitude > info.limit) node.refuse(attribute, node.requiredAttribute(attribute), info.expectation);
}

// Readings without noise would outweigh all others without bound; and no tracker is a decimetre off.
void requireNoise(const XmlNode& node, const std::string& attribute, double sum) {
  constexpr double kLeast = 1e-9, kMost = 0.1;  // m
  if (sum >= kLeast && sum <= kMost) return;
  node.refuse(attribute, node.requiredAttribute(attribute),
              "expected, together with what grows by the metre, 0.001 to 100000 um");
}

double atMost(const XmlNode& node, const std::string& attribute, double limit) {
  const double value = notNegative(node, attribute);
  if (value > limit) node.refuse(attribute, node.requiredAttribute(attribute), fmt::format("expected 0 to {:.0f}", limit));
  return value;
}

Eigen::Vector3d millimetres(const XmlNode& node, const std::string& attribute) {
  const Eigen::Vector3d value = node.vector(attribute);
  requirePlausible(node, attribute, CellKind::millimetre, value.cwiseAbs().maxCoeff());
  return value * kMillimetre;
}

Eigen::Vector3d pointOf(const XmlNode& node) {
  Eigen::Vector3d point;
  const char* const attributes[] = {"x_mm", "y_mm", "z_mm"};
  for (int i = 0; i < 3; ++i) {
    const double value = numberOrZero(node, attributes[i]);
    requirePlausible(node, attributes[i], CellKind::millimetre, std::abs(value));
    point[i] = value * kMillimetre;
  }
  return point;
}

Target readTarget(const XmlNode& node) {
  Target target{node.requiredName("id"), std::nullopt};
  const int given = node.has("x_mm") + node.has("y_mm") + node.has("z_mm");
  if (given == 0) return target;
  if (given != 3) node.refuse("target", target.id, "expected all three of x_mm, y_mm and z_mm, or none");
  target.position_in_flange = pointOf(node);
  return target;
}

}  // namespace

Tracker readTracker(const XmlNode& node, std::vector<std::string>& warnings) {
  warnOfUnknown(node,
                {"model", "range_fixed_um", "range_per_m_um", "angle_fixed_um", "angle_per_m_um", "x_mm",
                 "y_mm", "z_mm"},
                {}, warnings);
  Tracker tracker;
  tracker.model = node.requiredAttribute("model");
  tracker.range_fixed = notNegative(node, "range_fixed_um") * kMicrometre;
  tracker.range_per_m = notNegative(node, "range_per_m_um") * kMicrometre;
  tracker.angle_fixed = notNegative(node, "angle_fixed_um") * kMicrometre;
  tracker.angle_per_m = notNegative(node, "angle_per_m_um") * kMicrometre;
  requireNoise(node, "range_fixed_um", tracker.range_fixed + tracker.range_per_m);
  requireNoise(node, "angle_fixed_um", tracker.angle_fixed + tracker.angle_per_m);
  tracker.station = pointOf(node);
  return tracker;
}

std::vector<Target> readTargets(const XmlNode& node, std::vector<std::string>& warnings) {
  warnOfUnknown(node, {}, {"target"}, warnings);
  std::vector<Target> targets;
  std::unordered_map<std::string, std::size_t> first_line;
  for (const XmlNode& child : node.children("target")) {
    warnOfUnknown(child, {"id", "x_mm", "y_mm", "z_mm"}, {}, warnings);
    targets.push_back(readTarget(child));
    const auto [first, added] = first_line.emplace(targets.back().id, child.line());
    if (!added) {
      child.refuse("id", targets.back().id,
                   fmt::format("expected an id that does not repeat; line {} has it first", first->second));
    }
  }
  return targets;
}

LoadCell readLoadCell(const XmlNode& node, std::vector<std::string>& warnings) {
  warnOfUnknown(node, {"parent", "xyz_mm", "rpy_deg", "force_sigma_n", "moment_sigma_nm", "axes"}, {},
                warnings);
  LoadCell cell;
  cell.parent = node.requiredName("parent");
  cell.parent_from_cell.translation() = millimetres(node, "xyz_mm");
  if (node.has("axes")) cell.axes_link = node.requiredName("axes");
  if (!cell.axes_link || node.has("rpy_deg")) {
    const Eigen::Vector3d rpy = node.vector("rpy_deg");
    requirePlausible(node, "rpy_deg", CellKind::degree, rpy.cwiseAbs().maxCoeff());
    if (!cell.axes_link) cell.parent_from_cell.linear() = rotationFromRpy(rpy * kDegree);
  }
  constexpr double kMostSigma = 1e6;  // N and Nm, as of the readings themselves
  cell.force_sigma = atMost(node, "force_sigma_n", kMostSigma);
  cell.moment_sigma = atMost(node, "moment_sigma_nm", kMostSigma);
  const double lever = cell.parent_from_cell.translation().norm() / kMillimetre;
  if (lever > 0.0 && lever < 1.0)
    warnings.push_back(node.warning("xyz_mm", node.requiredAttribute("xyz_mm"), "less than a millimetre: written in metres?"));
  return cell;
}

Tool readTool(const XmlNode& node, std::vector<std::string>& warnings) {
  warnOfUnknown(node, {"mass_kg", "com_mm"}, {}, warnings);
  constexpr double kMostMass = 5000.0;  // kg, more than the strongest arm carries
  return {atMost(node, "mass_kg", kMostMass), millimetres(node, "com_mm")};
}

TableReference readTableReference(const XmlNode& node, std::vector<std::string>& warnings) {
  warnOfUnknown(node, {"file", "frame"}, {}, warnings);
  TableReference table{{node.requiredName("file"), "file", node.line()}, PointFrame::tracker};
  const std::string frame = node.attribute("frame").value_or("tracker");
  if (frame == "base_link") {
    table.frame = PointFrame::base_link;
  } else if (frame != "tracker") {
    node.refuse("frame", frame, "expected base_link, or tracker, or no such attribute");
  }
  return table;
}

}  // namespace stiffscope
